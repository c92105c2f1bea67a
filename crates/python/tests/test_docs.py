"""The guide's examples run."""

import re

import pytest


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("page", ["docs/python.md", "README.md"])
def test_regress_the_examples_run(root, page, monkeypatch):
    pytest.importorskip("pyarrow")
    monkeypatch.chdir(root)
    blocks = re.findall(r"```python\n(.*?)```", (root / page).read_text(encoding="utf-8"), re.S)
    assert blocks, f"no example in {page}"
    exec(compile("\n".join(blocks), page, "exec"), {})
