"""Figure files for publication: which are drawn, and reuse while their data are unchanged."""
