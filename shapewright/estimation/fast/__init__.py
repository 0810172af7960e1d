"""The fast estimator: several starts, joint least squares over pose and parameters, options as branches (ours)."""
