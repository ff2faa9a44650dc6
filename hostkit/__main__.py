"""``python -m hostkit`` is ``hostkit``."""

from hostkit.cli.main import main

main()
