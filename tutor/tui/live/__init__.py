"""The live page: topics, parameters, services and the graph of the user's own domain, from a child process."""
