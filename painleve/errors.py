"""The one exception that a user's input can raise: a single line that says what, where and what to do."""


class InputError(ValueError):
    """Bad input from a user; its message is one line and ends up on stderr with exit status 2."""
