"""Bodies of requests (``In``) and responses (``Out``), one file a resource."""
