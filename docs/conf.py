"""How Sphinx makes the site of these documents: see docs/index.md."""

import pathlib
import sys

import waggle_tasks

sys.path.insert(0, str(pathlib.Path(__file__).parent / 'extensions'))

project = 'waggle_tasks'
author = copyright = 'The waggle_tasks authors'
version = release = waggle_tasks.__version__

extensions = [
  'myst_nb',
  'sphinx.ext.autodoc',
  'sphinx.ext.napoleon',
  'reference_tables',
]
html_theme = 'furo'
html_title = f'waggle_tasks {release}'

myst_heading_anchors = 4
myst_enable_extensions = ['colon_fence']
nb_execution_mode = 'off'  # tests/test_site.py runs them.
autodoc_member_order = 'bysource'
autodoc_typehints = 'description'
autodoc_typehints_description_target = 'documented'
napoleon_numpy_docstring = False
napoleon_use_ivar = True
