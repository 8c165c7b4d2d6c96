"""Runs the cells of docs/from-python.ipynb, one after the other, as a notebook does: test_notebook.py [NOTEBOOK]

What a cell ends in must show itself: as picture, as vectors, or as text. Environment: LIMNER_LIBRARY, the library."""
import ast
import json
import os
import pathlib
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent.parent
sys.path.insert(0, str(HERE.parent))


def shown(value):
    """What a notebook would show of it, which must be there."""
    for name, begin in (("_repr_png_", b"\x89PNG"), ("_repr_svg_", "<?xml")):
        if hasattr(value, name):
            content = getattr(value, name)()
            if not content.startswith(begin):
                raise AssertionError(f"{name} gives {content[:20]!r}")
            return f"{name} {len(content)}"
    return repr(value)


def run(source, names):
    """Runs a cell; its last line, where it is an expression, is what it shows."""
    tree = ast.parse(source)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, "cell", "exec"), names)
    if last is not None:
        print(shown(eval(compile(ast.Expression(last.value), "cell", "eval"), names)))


def main(path):
    notebook = json.loads(pathlib.Path(path).read_text(encoding="utf-8"))
    cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    if len(cells) < 5:
        raise AssertionError("the notebook has hardly any cells")
    if any(cell["outputs"] or cell["execution_count"] for cell in cells):
        raise AssertionError("the notebook was saved with what it shows: clear all outputs")
    names = {"__name__": "__main__"}
    with tempfile.TemporaryDirectory() as folder:  # the paths in it are those beside the page
        os.symlink(ROOT / "examples", pathlib.Path(folder, "examples"))
        os.mkdir(pathlib.Path(folder, "docs"))
        os.chdir(pathlib.Path(folder, "docs"))
        for number, cell in enumerate(cells, 1):
            try:
                run("".join(cell["source"]), names)
            except Exception:
                print(f"cell {number}:\n{''.join(cell['source'])}", file=sys.stderr)
                raise
        for made in ("box.png", "box.pdf"):
            if not os.path.getsize(made):
                raise AssertionError(f"{made} is empty")
        os.chdir(ROOT)


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else ROOT / "docs" / "from-python.ipynb")
