"""Records of runs: facts, traces, trends, decisions and notices."""
