"""The operator's console from outside: a browser of our own, a client that misbehaves, and how soon a page lets go."""
