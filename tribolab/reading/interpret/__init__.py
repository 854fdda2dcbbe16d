"""Words, stated amounts and physical relations that tell what a column measures.

The decision itself is in `tribolab.reading.unknown.columns`.
"""
