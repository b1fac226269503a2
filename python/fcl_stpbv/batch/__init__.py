"""Runs thousands of proofs, samples, postures or conversions, on all cores, a Dask cluster or a job array (docs/scale.md)."""
