"""Tables of doc/benchmarks.md: a module for each kind."""
