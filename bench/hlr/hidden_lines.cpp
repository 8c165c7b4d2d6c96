// The exact hidden-line removal of OpenCASCADE, to be compared with (bench/hlr/run): hidden_lines VIEW MODEL OUT
// MODEL is STEP, IGES, or STL, whose triangles become faces. VIEW is front, right or top, z up. OUT gets a line for
// each polyline: its class (sharp, smooth, outline), then x and y of its points, mm. Prints seconds of the processor:
// reading, hiding.
#include <algorithm>
#include <cmath>
#include <ctime>
#include <cstdio>
#include <cstring>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include <BRepAdaptor_Curve.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <Bnd_Box.hxx>
#include <GCPnts_TangentialDeflection.hxx>
#include <HLRAlgo_Projector.hxx>
#include <HLRBRep_Algo.hxx>
#include <HLRBRep_HLRToShape.hxx>
#include <IGESControl_Reader.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <Poly_Triangulation.hxx>
#include <RWStl.hxx>
#include <STEPControl_Reader.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Wire.hxx>
#include <gp_Pln.hxx>

namespace
{

double seconds()
{
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

// One planar face a triangle; edges that turn by less than 30 degrees are smooth.
TopoDS_Shape shape_of_mesh(const char *path)
{
    Handle(Poly_Triangulation) mesh = RWStl::ReadFile(path);
    BRep_Builder                                      builder;
    TopoDS_Shell                                      shell;
    std::map<std::tuple<double, double, double>, int> places;
    std::vector<TopoDS_Vertex>                        vertices;
    std::unordered_map<uint64_t, TopoDS_Edge>         edges;
    builder.MakeShell(shell);
    for (int i = 1; !mesh.IsNull() && i <= mesh->NbTriangles(); i++) {
        int    n[3], at[3];
        gp_Pnt p[3];
        mesh->Triangle(i).Get(n[0], n[1], n[2]);
        for (int k = 0; k < 3; k++) {
            p[k] = mesh->Node(n[k]);
            const auto key = std::make_tuple(p[k].X(), p[k].Y(), p[k].Z());
            const auto found = places.emplace(key, static_cast<int>(vertices.size()));
            if (found.second) {
                vertices.emplace_back();
                builder.MakeVertex(vertices.back(), p[k], 1e-7);
            }
            at[k] = found.first->second;
        }
        const gp_Vec across = gp_Vec(p[0], p[1]).Crossed(gp_Vec(p[0], p[2]));
        if (across.Magnitude() < 1e-12)
            continue;
        TopoDS_Wire wire;
        builder.MakeWire(wire);
        bool whole = true;
        for (int k = 0; k < 3 && whole; k++) {
            const int      a = at[k], b = at[(k + 1) % 3];
            const uint64_t key = static_cast<uint64_t>(std::min(a, b)) << 32 | static_cast<uint64_t>(std::max(a, b));
            auto           found = edges.find(key);
            if (found == edges.end()) {
                BRepBuilderAPI_MakeEdge make(vertices[static_cast<size_t>(std::min(a, b))],
                                             vertices[static_cast<size_t>(std::max(a, b))]);
                whole = make.IsDone();
                if (whole)
                    found = edges.emplace(key, make.Edge()).first;
            }
            if (whole)
                builder.Add(wire, a < b ? found->second : TopoDS::Edge(found->second.Reversed()));
        }
        if (!whole)
            continue;
        BRepBuilderAPI_MakeFace face(gp_Pln(p[0], gp_Dir(across)), wire);
        if (face.IsDone())
            builder.Add(shell, face.Face());
    }
    BRepLib::EncodeRegularity(shell, 30 * 3.14159265358979 / 180);
    return shell;
}

TopoDS_Shape read(const std::string &path)
{
    const std::string ending = path.substr(path.find_last_of('.') + 1);
    if (ending == "stl")
        return shape_of_mesh(path.c_str());
    if (ending == "igs" || ending == "iges") {
        IGESControl_Reader reader;
        if (reader.ReadFile(path.c_str()) == IFSelect_RetDone)
            reader.TransferRoots();
        return reader.OneShape();
    }
    STEPControl_Reader reader;
    if (reader.ReadFile(path.c_str()) == IFSelect_RetDone)
        reader.TransferRoots();
    return reader.OneShape();
}

void put(std::FILE *out, const char *kind, const TopoDS_Shape &lines, double chord)
{
    if (lines.IsNull())
        return;
    BRepLib::BuildCurves3d(lines);
    for (TopExp_Explorer at(lines, TopAbs_EDGE); at.More(); at.Next()) {
        BRepAdaptor_Curve           curve(TopoDS::Edge(at.Current()));
        GCPnts_TangentialDeflection steps(curve, 0.1, chord);
        std::fprintf(out, "%s", kind);
        for (int i = 1; i <= steps.NbPoints(); i++)
            std::fprintf(out, " %.6f %.6f", steps.Value(i).X(), steps.Value(i).Y());
        std::fprintf(out, "\n");
    }
}

} // namespace

int main(int count, char **words)
{
    if (count != 4)
        return 1;
    Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
    const double       begin = seconds();
    const TopoDS_Shape shape = read(words[2]);
    const double       read_at = seconds();
    if (shape.IsNull())
        return 1;
    const gp_Dir eye = !std::strcmp(words[1], "front")   ? gp_Dir(0, -1, 0)
                       : !std::strcmp(words[1], "right") ? gp_Dir(1, 0, 0)
                                                         : gp_Dir(0, 0, 1),
                 right = !std::strcmp(words[1], "right") ? gp_Dir(0, 1, 0) : gp_Dir(1, 0, 0);
    Handle(HLRBRep_Algo) algo = new HLRBRep_Algo();
    algo->Add(shape, 0);
    algo->Projector(HLRAlgo_Projector(gp_Ax2(gp_Pnt(0, 0, 0), eye, right)));
    algo->Update();
    algo->Hide();
    HLRBRep_HLRToShape lines(algo);
    std::FILE         *out = std::fopen(words[3], "w");
    if (!out)
        return 1;
    const double read_and_hidden = seconds();
    Bnd_Box      box;
    BRepBndLib::Add(shape, box);
    const double chord = std::sqrt(box.SquareExtent()) / 40000;
    put(out, "sharp", lines.VCompound(), chord);
    put(out, "smooth", lines.Rg1LineVCompound(), chord);
    put(out, "outline", lines.OutLineVCompound(), chord);
    std::fclose(out);
    std::printf("%.3f %.3f\n", read_at - begin, read_and_hidden - read_at);
    return 0;
}
