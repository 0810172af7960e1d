"""Estimating the parameters of a query (paper section 3.3)."""
