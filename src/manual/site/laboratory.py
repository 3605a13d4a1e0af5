"""Links that open lessons and scenes in the site's laboratory, which runs in the browser (make site)."""

import base64
import html
import re
import shlex
import subprocess
import zlib
from urllib.parse import quote

from page import output_of

RENDER = re.compile(r'<pre><code>(cuvette render experiments/(scenes/\S+\.yaml) [^\n]*)\n</code></pre>\n')
QUESTION = re.compile(r'(<p class="question".*?</p>\n)', re.S)


class Laboratory:
    """address: its folder, relative to the pages; None: the documentation has no laboratory."""

    def __init__(self, root, program, address):
        self.root, self.program, self.address = root, program, address

    def link(self, fragment, words):
        return f'<a class="open" href="{html.escape(self.address + fragment)}">{words}</a>'

    def add(self, page, body):
        if not self.address:
            return body
        if page.name == 'index':
            links = self.link('', 'Open the laboratory') + '<a class="open" href="lessons.html">Choose a lesson</a>'
            return body.replace('</p>\n</div>\n', f'</p>\n<p class="opens">{links}</p>\n</div>\n', 1)
        if page.name.startswith('lesson-'):
            link = self.link(f'#lesson={quote(page.name.removeprefix("lesson-"))}', 'Open in the laboratory')
            return QUESTION.sub(lambda match: f'{match[1]}<p>{link}</p>\n', body, count=1)
        if page.name == 'gallery':
            return RENDER.sub(lambda match: f'{match[0]}<p>{self.scene(match[1], match[2])}</p>\n', body)
        return body

    def scene(self, command, name):
        return self.link(self.code(html.unescape(command)) or f'?scene={quote(name)}', 'Open in the laboratory')

    def code(self, command):
        """The link that holds the scene of a command with changed parameters; None without changes, and for a scene
        that reads files, which no link can hold: the laboratory then opens the scene file."""
        _, _, scene, *words = shlex.split(command)
        changes = [word for at, word in enumerate(words) if '--set' in (word, words[at - 1])]
        if not changes:
            return None
        text = output_of(self.program, 'scene', scene, *changes, cwd=self.root)
        code = '#scene=' + base64.urlsafe_b64encode(zlib.compress(text.encode(), 9)).decode().rstrip('=')
        can_open = subprocess.run([self.program, 'scene', code], capture_output=True).returncode == 0
        return code if can_open else None
