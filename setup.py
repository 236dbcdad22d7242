"""Packaging: the top-level folders become one import name, `waggle_tasks`."""

import pathlib
import re

import setuptools

HERE = pathlib.Path(__file__).parent
FOLDERS = ('entities', 'arenas', 'agents', 'experiments')

VIDEO = ('av>=17.1',)
CLUSTER = ('distributed>=2025.1',)
ANALYSIS = ('matplotlib>=3.9',)
EVENTS = ('aedat>=2.3',)
RL = ('gymnasium>=1', 'pettingzoo>=1.25')
TEST = (
  'pytest>=8', 'pytest-timeout>=2.2', 'pytest-xdist>=3.1', 'hypothesis>=6.16',
  'setuptools>=77',
  *CLUSTER, *ANALYSIS, *VIDEO, *RL, *EVENTS,
  'dv-processing>=2',  # It writes what tests read.
)  # fmt: skip
DOCS = ('sphinx>=8.2', 'furo>=2025.7', 'myst-nb>=1.3')
DEV = (*TEST, *DOCS, 'ruff>=0.14', 'mypy>=2.4', 'build>=1')


def version() -> str:
  """Returns the version without importing the package."""
  text = (HERE / 'waggle_tasks' / '_version.py').read_text(encoding='utf-8')
  return re.search(r"^__version__ = '(.+)'$", text, re.MULTILINE).group(1)


def urls() -> dict[str, str]:
  """Returns where the project is, as far as it says so."""
  text = (HERE / 'CITATION.cff').read_text(encoding='utf-8')
  found = re.search(r"^repository-code: '?([^\s']+)", text, re.MULTILINE)
  return {'Source': found[1]} if found else {}


def description() -> str:
  """Returns README.md as it can be read alone.

  A package index has none of the files beside it: of pictures it shows the
  words, of links to these files the names.
  """
  text = (HERE / 'README.md').read_text(encoding='utf-8')
  text = re.sub(r'<!--.*?-->\n\n', '', text, flags=re.DOTALL)
  text = re.sub(r'!\[([^]]*)\]\((?!https?:)[^)]*\)', r'*\1*', text)
  return re.sub(r'\[([^]]*)\]\((?!https?:|#)[^)]*\)', r'\1', text)


def packages() -> list[str]:
  """Returns every package under the one import name."""
  names = setuptools.find_packages(include=['waggle_tasks', 'waggle_tasks.*'])
  for folder in FOLDERS:
    names.append(f'waggle_tasks.{folder}')
    names += [
      f'waggle_tasks.{folder}.{name}'
      for name in setuptools.find_packages(str(HERE / folder))
    ]
  return names


setuptools.setup(
  name='waggle-tasks',
  version=version(),
  description='A motion-communication task suite for dm_control composer.',
  long_description=description(),
  long_description_content_type='text/markdown',
  author='The waggle_tasks authors',
  project_urls=urls(),
  keywords='dm_control MuJoCo drone Crazyflie benchmark motion communication',
  classifiers=[
    'Development Status :: 4 - Beta',
    'Environment :: Console',
    'Intended Audience :: Science/Research',
    'Operating System :: POSIX :: Linux',
    'Programming Language :: Python :: 3',
    'Programming Language :: Python :: 3.11',
    'Programming Language :: Python :: 3.12',
    'Topic :: Scientific/Engineering :: Artificial Intelligence',
    'Topic :: Scientific/Engineering :: Image Recognition',
  ],
  license='Apache-2.0',
  license_files=['LICENSE', 'CITATION.cff'],  # So sources hold both.
  python_requires='>=3.11,<3.13',
  packages=packages(),
  package_dir={
    'waggle_tasks': 'waggle_tasks',
    **{f'waggle_tasks.{folder}': folder for folder in FOLDERS},
  },
  package_data={'': ['*.xml', '*.json', '*.css', '*.js', '*.npz', 'py.typed']},
  install_requires=[
    'absl-py>=2',
    'dm-control==1.0.50',
    'dm-env>=1.6',
    'mujoco>=3.17,<4',
    'numpy>=2',
    'opencv-python-headless>=5,<6',
    'packaging>=23',
    'pyopengl>=3.1.4',
    'scipy>=1.13',
    'tqdm>=4.60',
    'xxhash>=3',
  ],
  extras_require={
    'video': VIDEO,
    'cluster': CLUSTER,
    'analysis': ANALYSIS,
    'rl': RL,
    'events': EVENTS,
    'test': TEST,
    'docs': DOCS,
    'dev': DEV,
  },
  entry_points={
    'console_scripts': ['waggle = waggle_tasks.experiments.main:main']
  },
  zip_safe=False,
)
