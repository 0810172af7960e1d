"""What lasts: tables, artefacts, jobs, and the library of procedural models."""
