"""Live panels: topics, parameters, services and the graph of the user's own domain, as a child process reports them."""
