"""`python -m cli` is the `shapewright` command."""

from cli.app import main

main()
