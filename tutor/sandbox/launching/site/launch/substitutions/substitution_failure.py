"""A substitution that has no text."""


class SubstitutionFailure(RuntimeError):  # noqa: N818, RUF100 - the original's name
    """Raised by perform()."""
