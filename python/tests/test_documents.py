"""The programs that README and the book show run."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize("page", ["README.md", "docs/book/python.md"])
def test_shown_programs_run(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    programs = re.findall(r"```python\n(.*?)```", (ROOT / page).read_text(), re.DOTALL)
    assert programs
    scope: dict[str, object] = {}
    for program in programs:
        exec(program, scope)
    if page == "README.md":
        assert (tmp_path / "fragility.png").stat().st_size > 10_000
