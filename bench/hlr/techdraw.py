# Seconds of the processor that FreeCAD's TechDraw takes for the lines of one view: freecadcmd techdraw.py (models and views in HLR_MODELS, "FILE:VIEW …")
import os
import time

import FreeCAD
import Part
import TechDraw

eyes = {"front": (0, -1, 0), "right": (1, 0, 0), "top": (0, 0, 1)}
for word in os.environ["HLR_MODELS"].split():
    path, view = word.rsplit(":", 1)
    begin = time.process_time()
    shape = Part.Shape()
    shape.read(path)
    read = time.process_time()
    TechDraw.projectEx(shape, FreeCAD.Vector(*eyes[view]))
    print(f"{os.path.basename(path)} {view} | {read - begin:.3f} {time.process_time() - read:.3f}")
