"""`python -m waggle_tasks` is the `waggle` command."""

import sys

from waggle_tasks.experiments import main

if __name__ == '__main__':
  sys.exit(main.main())
