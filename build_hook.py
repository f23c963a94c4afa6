"""Writes the commit of the sources into what is built from them, for `cosim.provenance`."""

from __future__ import annotations

import importlib.util
import tempfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class CommitHook(BuildHookInterface):
    """Adds `cosim/commit.txt` to wheels and archives of a checkout; an archive's own one goes on into its wheel."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Before the files are gathered."""
        root = Path(self.root)
        if version == "editable" or (root / "cosim" / "commit.txt").is_file():
            return
        spec = importlib.util.spec_from_file_location("provenance", root / "cosim" / "provenance.py")
        assert spec is not None
        assert spec.loader is not None
        provenance = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(provenance)
        self._folder = tempfile.TemporaryDirectory()
        file = Path(self._folder.name) / "commit.txt"
        file.write_text(provenance.commit_of(root) + "\n", encoding="utf-8")
        build_data["force_include"][str(file)] = "cosim/commit.txt"
