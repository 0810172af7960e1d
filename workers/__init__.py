"""Celery workers that carry out jobs."""
