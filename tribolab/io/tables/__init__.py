"""Tables of numbers: schemas, binary formats, pieces."""
