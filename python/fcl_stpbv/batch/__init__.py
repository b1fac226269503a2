"""Proofs, samples, postures and conversions by the thousand, on all cores, a Dask cluster or a job array (docs/scale.md)."""
