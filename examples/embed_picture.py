"""A model as picture and as vectors: embed_picture.py MODEL OUT.png OUT.svg"""
import sys

import limner


def main(model: str, picture: str, vectors: str) -> int:
    scene = limner.Scene(model)  # read once, drawn twice
    print("parts:", ", ".join(part["name"] for part in scene.info["parts"]))
    limner.draw(scene, "hatch", (320, 240)).save(picture)
    limner.draw_svg(scene, "technical", page="A4", frame=True).save(vectors)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main(*sys.argv[1:]))
    except limner.Error as error:
        sys.exit(f"{error}\n{error.hint}")
