"""The REST service and the dashboard it serves."""
