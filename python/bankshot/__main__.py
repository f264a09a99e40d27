"""``python -m bankshot`` is the program ``bankshot``."""

from ._commands import main

main()
