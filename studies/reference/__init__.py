"""Published facts, each found again by a route that does not use the published formula."""
