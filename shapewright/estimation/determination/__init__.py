"""What a query says about the parameters of its fit, and how surely (ours)."""
