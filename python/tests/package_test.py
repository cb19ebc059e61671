"""The package itself: help that can be read, and types."""

import inspect
import os
import pydoc
import re
import unittest

import support  # noqa: F401: a home of its own
import gaitd


class Documentation(unittest.TestCase):
    def test_everything_public_says_what_it_does_with_types(self):
        for name in gaitd.__all__:
            thing = getattr(gaitd, name)
            if name.startswith("__"):
                continue
            self.assertTrue(inspect.getdoc(thing), name)
            members = [(name, thing)] if inspect.isfunction(thing) else [
                (f"{name}.{key}", value) for key, value in vars(thing).items()
                if not key.startswith("_") and (inspect.isfunction(value) or isinstance(value, (property, classmethod)))
            ]  # fmt: skip
            for label, member in members:
                self.assertTrue(inspect.getdoc(member), label)
                function = getattr(member, "fget", None) or getattr(member, "__func__", member)
                signature = inspect.signature(function)
                self.assertIsNot(signature.return_annotation, inspect.Signature.empty, label)
                for parameter in list(signature.parameters.values()):
                    self.assertTrue(
                        parameter.name in ("self", "cls") or parameter.annotation is not inspect.Parameter.empty,
                        f"{label}: {parameter.name}",
                    )

    def test_help_can_be_read(self):
        text = pydoc.plain(pydoc.render_doc(gaitd.Log))
        for words in ("float64 of shape (ticks,)", "Raises :class:`MissingSignal`", "walk.mcap.columns"):
            self.assertIn(words, text)
        self.assertLess(max(map(len, text.splitlines())), 200)
        self.assertTrue(os.path.exists(os.path.join(os.path.dirname(gaitd.__file__), "py.typed")))

    def test_the_stub_names_what_the_binding_has(self):
        with open(os.path.join(os.path.dirname(gaitd.__file__), "_native.pyi"), encoding="utf-8") as file:
            stub = set(re.findall(r"^(?:class |def |)(\w+)[(:]", file.read(), re.MULTILINE))
        public = {name for name in dir(gaitd._native) if not name.startswith("_")}
        self.assertEqual({name for name in stub if name not in ("from", "import")}, public)


if __name__ == "__main__":
    unittest.main()
