"""Benchmarks: speed, memory and hit rates, as ratios to a peer in the same run."""
