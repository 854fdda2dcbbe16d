"""What is recorded of runs, curves, surfaces and models: typed, made by whoever has the data."""
