"""The .pyi beside the module says what is there: every public name, member and argument, and nothing else."""

import ast
import inspect
import pathlib
import re
import unittest

import laterna

STUB = ast.parse((pathlib.Path(laterna.__file__).parent / "__init__.pyi").read_text())


def is_public(name):
    return not name.startswith("_") or name in ("__init__", "__getitem__", "__len__")


def stub_functions(body):
    return {node.name: node for node in body if isinstance(node, ast.FunctionDef)}


def stub_arguments(function):
    """Names with their defaults' values; no default: ..."""
    arguments = [a.arg for a in function.args.args]
    defaults = [ast.literal_eval(d) for d in function.args.defaults]
    return dict(zip(arguments, [...] * (len(arguments) - len(defaults)) + defaults))


def real_arguments(function):
    """The same from the first line of the docstring, where pybind11 puts the signature."""
    line = function.__doc__.splitlines()[0]
    inside = re.match(r"\w+\((.*)\) -> ", line).group(1)
    tree = ast.parse(f"def f({inside}): ...").body[0]
    return stub_arguments(tree)


class Stub(unittest.TestCase):
    def test_public_names(self):
        in_stub = set(stub_functions(STUB.body)) | {n.name for n in STUB.body if isinstance(n, ast.ClassDef)} | {"__version__"}
        self.assertEqual(in_stub, set(laterna.__all__))
        real = {name for name, value in inspect.getmembers(laterna) if is_public(name) and not inspect.ismodule(value)}
        self.assertEqual(real | {"__version__"}, set(laterna.__all__))

    def test_arguments_of_functions(self):
        for name, function in stub_functions(STUB.body).items():
            with self.subTest(name):
                self.assertEqual(stub_arguments(function), real_arguments(getattr(laterna, name)))

    def test_members_of_classes(self):
        for node in STUB.body:
            if not isinstance(node, ast.ClassDef) or node.name == "InputError":
                continue
            real = getattr(laterna, node.name)
            in_stub = stub_functions(node.body)
            members = {name for name in vars(real) if is_public(name)}
            if "__init__" not in in_stub:
                members.discard("__init__")  # pybind11's, which says that there is no constructor
            with self.subTest(node.name):
                self.assertEqual(set(in_stub), members)
            for name, function in in_stub.items():
                is_property = any(isinstance(d, ast.Name) and d.id == "property" for d in function.decorator_list)
                with self.subTest(f"{node.name}.{name}"):
                    self.assertEqual(is_property, isinstance(vars(real)[name], property))
                    if not is_property and name not in ("__getitem__", "__len__"):
                        self.assertEqual(stub_arguments(function), real_arguments(getattr(real, name)))

    def test_everything_has_a_docstring(self):
        for name in laterna.__all__:
            value = getattr(laterna, name)
            if not inspect.isclass(value):
                self.assertTrue(name == "__version__" or len(value.__doc__.splitlines()) > 1, name)
                continue
            for member, what in vars(value).items():
                if is_public(member) and isinstance(what, property):
                    self.assertTrue(what.__doc__, f"{name}.{member}")


if __name__ == "__main__":
    unittest.main()
