"""What the documentation consists of."""

import subprocess
from dataclasses import dataclass, field


class Trouble(Exception):
    """One line for the user: what is wrong, where, what to do."""


def output_of(*command, **options):
    """What a program prints."""
    return subprocess.run(command, check=True, capture_output=True, encoding='utf-8', **options).stdout


@dataclass
class Group:
    """An entry of the navigation: its pages come from the files that match the patterns, relative to the root."""

    title: str
    purpose: str
    patterns: tuple
    pages: list = field(default_factory=list)


@dataclass
class Page:
    """body is HTML with links as in the source, relative to it; Links.resolve makes them links of the site."""

    name: str
    label: str  # in the navigation
    title: str  # HTML
    body: str
    purpose: str = ''  # HTML, one line
    names: tuple = ()  # C names that have anchors on the page
    source: str = ''  # relative to the root
    group: Group = None

    @property
    def file(self):
        return f'{self.name}.html'
