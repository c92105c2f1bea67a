"""No page of the site fetches anything from the network, and no link within it leads nowhere. `check.py SITE`."""

import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

FETCHED = {
    "audio": "src",
    "embed": "src",
    "iframe": "src",
    "img": "src",
    "image": "href",
    "link": "href",
    "object": "data",
    "script": "src",
    "source": "src",
    "use": "href",
    "video": "src",
}
"""What a browser fetches of a page, by the attribute that names it; a link (`a`) is followed by people."""
BY_STYLE = re.compile(r"""(?:url\(\s*|@import\s+)["']?((?:https?:)?//[^"')\s]+)""")
BY_SCRIPT = re.compile(r"""(?:fetch|import|importScripts|\.open)\(\s*["'`]((?:https?:)?//[^"'`]+)""")


class Page(HTMLParser):
    """What a page fetches, and where its links lead."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.fetched: list[str] = []
        self.links: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        given = {name.removeprefix("xlink:"): value or "" for name, value in attributes}
        # `canonical`, `next` and the like are told and not fetched.
        told = tag == "link" and given.get("rel") in ("canonical", "next", "prev", "index", "search", "author")
        if tag in FETCHED and FETCHED[tag] in given and not told:
            self.fetched.append(given[FETCHED[tag]])
        self.fetched += [part.split()[0] for part in given.get("srcset", "").split(",") if part.strip()]
        if tag == "a" and "href" in given:
            self.links.append(given["href"])
        if "srcdoc" in given:
            self.fetched += Page(given["srcdoc"]).fetched


def is_remote(address: str) -> bool:
    return urlsplit(address).scheme in ("http", "https", "ftp", "ws", "wss") or address.startswith("//")


def leads_nowhere(address: str, file: Path) -> bool:
    parts = urlsplit(address)
    if parts.scheme or not parts.path:
        return False
    target = file.parent / unquote(parts.path)
    return not (target / "index.html" if target.is_dir() else target).is_file()


def faults_of(file: Path, site: Path) -> list[str]:
    text = file.read_text(encoding="utf-8")
    faults = [f"fetches {address}" for pattern in (BY_STYLE, BY_SCRIPT) for address in pattern.findall(text)]
    if file.suffix == ".html":
        page = Page(text)
        faults += [f"fetches {address}" for address in page.fetched if is_remote(address)]
        # rustdoc checks its own links; pages of results that a notebook shows lead to the files beside them.
        if file.relative_to(site).parts[0] not in ("rust", "pages"):
            near = [*page.fetched, *page.links]
            faults += [f"leads nowhere: {address}" for address in near if leads_nowhere(address, file)]
    return [f"{file.relative_to(site)} {fault}" for fault in faults]


def check_itself() -> None:
    """A page that does all that is forbidden is found out."""
    for text in ['<img src="https://a.org/b.png">', '<script src="//a.org/b.js"></script>']:
        assert any(map(is_remote, Page(text).fetched)), text
    assert BY_STYLE.search('@import "https://fonts.org/css"') and BY_STYLE.search("src: url(//fonts.org/x.woff2)")
    assert BY_SCRIPT.search('fetch("https://a.org/x.json")')


def main() -> None:
    site = Path(sys.argv[1])
    check_itself()
    files = [file for file in sorted(site.rglob("*")) if file.suffix in (".html", ".css", ".js", ".svg")]
    faults = [fault for file in files for fault in faults_of(file, site)]
    print(*faults, sep="\n", end="\n" if faults else "")
    print(f"site: {len(files)} pages, styles and scripts, {len(faults)} of them at fault")
    sys.exit(1 if faults or len(files) < 50 else 0)


if __name__ == "__main__":
    main()
