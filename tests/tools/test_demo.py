"""The page of ./dev demo is well formed whatever commands print, and needs nothing but its folder."""

import html.parser
import pathlib
import re
import sys
import unittest

TOOLS = pathlib.Path(__file__).resolve().parents[2] / "tools/demo"
sys.path.insert(0, str(TOOLS))
import demo
from story import STORY, Chapter, Figure


class Balanced(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.open = []

    def handle_starttag(self, tag, attributes):
        if tag not in ("meta", "img"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, (tag, self.getpos())


class Page(unittest.TestCase):
    def test_what_commands_print_is_text(self):
        chapter = Chapter("1 < 2", "10^7 & more", [Figure("<b>", ["echo '</pre><script>$story & \"'"])])
        section = demo.chapter_html(chapter)
        self.assertIn("&lt;/pre&gt;&lt;script&gt;$story &amp; &quot;", section)
        self.assertIn("10<sup>7</sup> &amp; more", section)
        self.assertNotIn("<script", section)
        page = demo.fill("page.html", story=section, examples="", seconds="1", version="1")
        parser = Balanced()
        parser.feed(page)
        self.assertEqual(parser.open, [])
        self.assertNotRegex(page, r"(?:src|href)=\"http")

    def test_a_command_that_fails_ends_the_demo(self):
        with self.assertRaisesRegex(SystemExit, "ended with status 3"):
            demo.run("exit 3")

    def test_commands_can_be_run_again(self):
        for command in (command for chapter in STORY for figure in chapter.figures for command in figure.commands):
            if re.search(r"hamflow (run|sweep)", command):
                self.assertIn("--force", command)


if __name__ == "__main__":
    unittest.main()
