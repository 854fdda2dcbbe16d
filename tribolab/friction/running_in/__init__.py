"""Running-in: from where on friction is steady, and what it is then."""
