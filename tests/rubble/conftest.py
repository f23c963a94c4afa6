"""Scenes that several tests share, loaded by path: there are no packages among the tests."""

import importlib.util
import sys
from pathlib import Path

import pytest


def load(name):
    """A module beside this file."""
    spec = importlib.util.spec_from_file_location(f"rubble_{name}", Path(__file__).with_name(f"{name}.py"))
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="session")
def scene():
    """The module `cone_scene.py`."""
    return load("cone_scene")
