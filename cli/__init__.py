"""The `shapewright` command."""
