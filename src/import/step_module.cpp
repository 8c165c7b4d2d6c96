// OpenCASCADE for C: STEP and IGES to meshes, edges and a tree. No exception leaves this file, and nothing of it is
// linked with the library: it is a module that the fenced child loads (step_library.c).
#include "import/step_module.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>
#include <new>
#include <string>
#include <tuple>
#include <unordered_map>
#include <vector>

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepLProp_SLProps.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GCPnts_TangentialDeflection.hxx>
#include <GeomLib.hxx>
#include <Message.hxx>
#include <NCollection_DataMap.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <Precision.hxx>
#include <Quantity_ColorRGBA.hxx>
#include <Standard_ErrorHandler.hxx>
#include <Standard_OutOfMemory.hxx>
#include <Standard_Version.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDF_Tool.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Iterator.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>

#include "import/cad_file.h"

namespace
{

// Chords of a part, of its diagonal, when nothing else is asked for; and the finest that are made of it, so that a
// mistaken unit does not take all memory.
constexpr double USUAL_CHORD = 1.0 / 2000, FINEST_CHORD = 1e-6;
// Two chords of a curve turn by no more, radians: small holes are round, too.
constexpr double CHORD_TURN = 0.25;
// Faces that turn by less along an edge go on smoothly into each other: cosine of 1 degree.
constexpr double SMOOTH = 0.99985;
// They are one surface when their curvatures differ by no more than this share of them; or of the part's size, below
// which a surface is flat.
constexpr double SAME_CURVATURE = 0.02, FLAT = 1e-3;
// A part so far from its origin, of its diagonal, is moved there and its node back: coordinates are single precision.
constexpr double FAR = 16;
// A triangle has no area when it is less than this, of the square of the part's diagonal.
constexpr double   NO_AREA = 1e-14;
constexpr unsigned DEEPEST = 512;

using cad::Failure;

struct Colour {
    bool  there = false;
    float rgba[4] = {0, 0, 0, 0};
    bool  operator<(const Colour &o) const
    {
        return there != o.there ? there < o.there : std::lexicographical_compare(rgba, rgba + 4, o.rgba, o.rgba + 4);
    }
};

struct Node {
    uint32_t    parent, mesh;
    std::string name;
    double      matrix[16];
};

// Triangles of one colour.
struct Group {
    std::vector<float>    positions, normals;
    std::vector<uint32_t> indices;
    std::vector<uint8_t>  edges;
    uint32_t              vertices() const
    {
        return static_cast<uint32_t>(positions.size() / 3);
    }
};

struct Lines {
    std::vector<float>    positions;
    std::vector<uint32_t> pairs;
    bool                  free = false; // some are no edges of faces
};

struct Mesh {
    std::string             name;
    std::map<Colour, Group> groups;
    Lines                   lines;
    double                  origin[3] = {0, 0, 0};
    bool                    empty() const
    {
        return groups.empty() && lines.pairs.empty();
    }
};

// --- putting -----------------------------------------------------------------------------------------------

class Answer
{
  public:
    Answer(step_put_fn put, void *to) : put_(put), to_(to)
    {
    }
    void bytes(const void *from, size_t size) const
    {
        if (size && !put_(to_, from, size))
            throw std::bad_alloc();
    }
    void number(uint32_t value) const
    {
        bytes(&value, sizeof value);
    }
    void text(const std::string &s) const
    {
        number(static_cast<uint32_t>(s.size()));
        bytes(s.data(), s.size());
    }
    template <typename T> void array(const std::vector<T> &v) const
    {
        bytes(v.data(), v.size() * sizeof(T));
    }

  private:
    step_put_fn put_;
    void       *to_;
};

void put_mesh(const Answer &a, const Mesh &m)
{
    a.text(m.name);
    a.number(static_cast<uint32_t>(m.groups.size()));
    for (const auto &[colour, group] : m.groups) {
        a.number(colour.there);
        a.bytes(colour.rgba, sizeof colour.rgba);
        a.number(group.vertices());
        a.number(static_cast<uint32_t>(group.indices.size()));
        a.array(group.positions);
        a.array(group.normals);
        a.array(group.indices);
        a.array(group.edges);
    }
    a.number(static_cast<uint32_t>(m.lines.positions.size() / 3));
    a.number(static_cast<uint32_t>(m.lines.pairs.size() / 2));
    a.number(m.lines.free);
    a.array(m.lines.positions);
    a.array(m.lines.pairs);
}

void put_node(const Answer &a, const Node &n)
{
    a.number(n.parent);
    a.text(n.name);
    a.bytes(n.matrix, sizeof n.matrix);
    a.number(n.mesh);
}

// --- meshes ------------------------------------------------------------------------------------------------

// A face as it lies in its part.
struct Faced {
    TopoDS_Face face;
    Handle(Poly_Triangulation) triangles;
    TopLoc_Location     location;
    std::vector<gp_Dir> normals; // of the nodes, outwards
    std::vector<bool>   known;   // those that the surface has: a cone has none at its tip
    // Pairs of nodes that lie along an edge, and what it is.
    std::unordered_map<uint64_t, step_edge> along;
};

uint64_t pair_of(int a, int b)
{
    return static_cast<uint64_t>(std::min(a, b)) << 32 | static_cast<uint64_t>(std::max(a, b));
}

void find_normals(Faced &f)
{
    const int count = f.triangles->NbNodes();
    Handle(Geom_Surface) surface = BRep_Tool::Surface(f.face);
    const bool inside_out = f.face.Orientation() == TopAbs_REVERSED;
    f.normals.assign(static_cast<size_t>(count) + 1, gp_Dir(0, 0, 1));
    f.known.assign(static_cast<size_t>(count) + 1, false);
    if (surface.IsNull() || !f.triangles->HasUVNodes())
        return;
    for (int i = 1; i <= count; i++) {
        gp_Dir n;
        if (GeomLib::NormEstim(surface, f.triangles->UVNode(i), 1e-7, n) > 1)
            continue;
        f.normals[static_cast<size_t>(i)] = inside_out ? n.Reversed() : n;
        f.known[static_cast<size_t>(i)] = true;
    }
}

gp_Pnt point_of(const Faced &f, int node)
{
    return f.triangles->Node(node).Transformed(f.location);
}

struct Mesher {
    double                     deflection;              // asked for; 0: of each part's size
    uint64_t                   left;                    // triangles that may come
    double                     chord = 0, diagonal = 1; // of the part at hand
    double                     coarser = 1;             // than they should be: how much larger chords became
    std::map<int, Faced>       faces;                   // by their number in index
    TopTools_IndexedMapOfShape index;
};

// An edge on one side of it: the face and its nodes along the edge.
struct Side {
    Faced *face;
    Handle(Poly_PolygonOnTriangulation) polygon;
};

void choose_origin(Mesh &mesh, const Bnd_Box &box, double diagonal)
{
    gp_XYZ middle = (box.CornerMin().XYZ() + box.CornerMax().XYZ()) / 2;
    if (middle.Modulus() > FAR * diagonal)
        middle.Coord(mesh.origin[0], mesh.origin[1], mesh.origin[2]);
}

void add_faces(Mesher &m, const TopoDS_Shape &shape)
{
    TopTools_IndexedMapOfShape all;
    TopExp::MapShapes(shape, TopAbs_FACE, all);
    for (int i = 1; i <= all.Extent(); i++) {
        Faced f;
        f.face = TopoDS::Face(all(i));
        f.triangles = BRep_Tool::Triangulation(f.face, f.location);
        if (f.triangles.IsNull())
            continue;
        const uint64_t count = static_cast<uint64_t>(f.triangles->NbTriangles());
        if (count > m.left)
            throw Failure{STEP_TOO_MANY, ""};
        m.left -= count;
        find_normals(f);
        m.faces.emplace(i, std::move(f));
    }
    m.index = all;
}

void put_point(std::vector<float> &to, const gp_Pnt &p, const double origin[3])
{
    for (int k = 0; k < 3; k++)
        to.push_back(static_cast<float>(p.Coord(k + 1) - origin[k]));
}

// Once around and across; without direction where a triangle has no area.
gp_Vec across(const Faced &f, const int n[3])
{
    const gp_Pnt a = point_of(f, n[0]);
    return gp_Vec(a, point_of(f, n[1])).Crossed(gp_Vec(a, point_of(f, n[2])));
}

// Where the surface has no normal, at tips, it is that of the triangles around.
gp_Vec tip_normal(const Faced &f, int node, bool turned)
{
    gp_Vec sum;
    for (int i = 1; i <= f.triangles->NbTriangles(); i++) {
        int n[3];
        f.triangles->Triangle(i).Get(n[0], n[1], n[2]);
        if (n[0] == node || n[1] == node || n[2] == node)
            sum += turned ? -across(f, n) : across(f, n);
    }
    return sum.Magnitude() > 0 ? sum.Normalized() : gp_Vec();
}

void put_face(Group &g, const Faced &f, const double origin[3], double diagonal)
{
    const uint32_t base = g.vertices();
    const bool     mirrored = f.location.Transformation().IsNegative();
    const bool     turned = (f.face.Orientation() == TopAbs_REVERSED) != mirrored;
    for (int i = 1; i <= f.triangles->NbNodes(); i++) {
        const auto k = static_cast<size_t>(i);
        put_point(g.positions, point_of(f, i), origin);
        const gp_Vec normal = f.known[k] ? gp_Vec(f.normals[k]) : tip_normal(f, i, turned);
        for (int c = 1; c <= 3; c++)
            g.normals.push_back(static_cast<float>(normal.Coord(c)));
    }
    for (int i = 1; i <= f.triangles->NbTriangles(); i++) {
        int n[3];
        f.triangles->Triangle(i).Get(n[0], n[1], n[2]);
        if (turned)
            std::swap(n[1], n[2]);
        if (across(f, n).Magnitude() <= NO_AREA * diagonal * diagonal)
            continue;
        for (int k = 0; k < 3; k++) {
            const auto found = f.along.find(pair_of(n[k], n[(k + 1) % 3]));
            g.indices.push_back(base + static_cast<uint32_t>(n[k] - 1));
            g.edges.push_back(static_cast<uint8_t>(found == f.along.end() ? STEP_INSIDE : found->second));
        }
    }
}

std::vector<Side> sides_of(Mesher &m, const TopoDS_Edge &edge, const TopTools_ListOfShape &faces)
{
    std::vector<Side>          sides;
    TopTools_IndexedMapOfShape seen;
    for (const TopoDS_Shape &shape : faces) {
        const int  number = m.index.FindIndex(shape);
        const auto found = m.faces.find(number);
        if (found == m.faces.end() || seen.Contains(shape))
            continue;
        seen.Add(shape);
        Faced &f = found->second;
        // A seam has its face on both sides; the other one's nodes are those of the edge turned round.
        const bool closed = BRep_Tool::IsClosed(edge, f.face);
        for (int k = 0; k < (closed ? 2 : 1); k++) {
            const TopoDS_Edge side = k ? TopoDS::Edge(edge.Reversed()) : edge;
            Handle(Poly_PolygonOnTriangulation) polygon =
                BRep_Tool::PolygonOnTriangulation(side, f.triangles, f.location);
            if (!polygon.IsNull() && polygon->NbNodes() > 1)
                sides.push_back({&f, polygon});
        }
    }
    return sides;
}

// Do the faces on both sides go on into each other?
bool is_smooth(const std::vector<Side> &sides)
{
    if (sides.size() != 2 || sides[0].polygon->NbNodes() != sides[1].polygon->NbNodes())
        return false;
    for (int i = 1; i <= sides[0].polygon->NbNodes(); i++) {
        const auto a = static_cast<size_t>(sides[0].polygon->Node(i));
        const auto b = static_cast<size_t>(sides[1].polygon->Node(i));
        if (sides[0].face->known[a] && sides[1].face->known[b] &&
            sides[0].face->normals[a].Dot(sides[1].face->normals[b]) < SMOOTH)
            return false;
    }
    return true;
}

// How a face bends at a node, outwards positive, the most first; false: it cannot be told.
bool bends(const Faced &f, int node, double out[2])
{
    BRepAdaptor_Surface surface(f.face, false);
    const gp_Pnt2d      at = f.triangles->UVNode(node);
    BRepLProp_SLProps   there(surface, at.X(), at.Y(), 2, 1e-7);
    if (!there.IsCurvatureDefined())
        return false;
    const bool reversed = f.face.Orientation() == TopAbs_REVERSED;
    out[0] = reversed ? -there.MinCurvature() : there.MaxCurvature();
    out[1] = reversed ? -there.MaxCurvature() : there.MinCurvature();
    return true;
}

// Is it one surface that was only cut in two there, as writers do with cylinders? Of faces that go on smoothly.
bool is_one_surface(const Mesher &m, const std::vector<Side> &sides)
{
    const int count = sides[0].polygon->NbNodes();
    for (int k = 1; k <= 3; k++) {
        const int node = 1 + (count - 1) * k / 4;
        double    a[2], b[2];
        if (!sides[0].face->triangles->HasUVNodes() || !sides[1].face->triangles->HasUVNodes() ||
            !bends(*sides[0].face, sides[0].polygon->Node(node), a) ||
            !bends(*sides[1].face, sides[1].polygon->Node(node), b))
            return false;
        for (int i = 0; i < 2; i++)
            if (std::abs(a[i] - b[i]) > SAME_CURVATURE * std::max(std::abs(a[i]), std::abs(b[i])) + FLAT / m.diagonal)
                return false;
    }
    return true;
}

void put_line(Lines &to, const std::vector<gp_Pnt> &points, const double origin[3])
{
    const auto base = static_cast<uint32_t>(to.positions.size() / 3);
    for (size_t i = 0; i < points.size(); i++) {
        put_point(to.positions, points[i], origin);
        if (i)
            for (uint32_t k = 0; k < 2; k++)
                to.pairs.push_back(base + static_cast<uint32_t>(i) - 1 + k);
    }
}

// Wires that bound no face.
void add_free(const Mesher &m, Mesh &mesh, const TopoDS_Edge &edge)
{
    BRepAdaptor_Curve curve(edge);
    if (!std::isfinite(curve.FirstParameter()) || Precision::IsInfinite(curve.FirstParameter()) ||
        Precision::IsInfinite(curve.LastParameter()))
        return;
    GCPnts_TangentialDeflection steps(curve, CHORD_TURN, m.chord);
    std::vector<gp_Pnt>         points;
    for (int i = 1; i <= steps.NbPoints(); i++)
        points.push_back(steps.Value(i));
    put_line(mesh.lines, points, mesh.origin);
    mesh.lines.free = true;
}

void add_edges(Mesher &m, Mesh &mesh, const TopoDS_Shape &shape)
{
    TopTools_IndexedDataMapOfShapeListOfShape edges;
    TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, edges);
    for (int i = 1; i <= edges.Extent(); i++) {
        const TopoDS_Edge edge = TopoDS::Edge(edges.FindKey(i));
        if (BRep_Tool::Degenerated(edge))
            continue;
        if (edges(i).IsEmpty()) {
            add_free(m, mesh, edge);
            continue;
        }
        const std::vector<Side> sides = sides_of(m, edge, edges(i));
        if (sides.empty())
            continue;
        const bool smooth = is_smooth(sides);
        for (const Side &s : sides)
            for (int k = 1; k < s.polygon->NbNodes() && !smooth; k++)
                s.face->along[pair_of(s.polygon->Node(k), s.polygon->Node(k + 1))] = STEP_SHARP;
        // Where a round face closes, or is only cut in two, nothing is to be seen.
        if (smooth && (sides[0].face == sides[1].face || is_one_surface(m, sides)))
            continue;
        std::vector<gp_Pnt> points;
        for (int k = 1; k <= sides[0].polygon->NbNodes(); k++)
            points.push_back(point_of(*sides[0].face, sides[0].polygon->Node(k)));
        put_line(mesh.lines, points, mesh.origin);
    }
}

// `colour_of` tells a face's colour; shapes are tessellated once, however often they are used.
template <typename ColourOf> Mesh mesh_of(Mesher &m, const TopoDS_Shape &shape, ColourOf colour_of)
{
    Mesh    mesh;
    Bnd_Box box;
    BRepBndLib::Add(shape, box, false);
    if (box.IsVoid())
        return mesh;
    const double diagonal = std::sqrt(box.SquareExtent());
    if (!std::isfinite(diagonal) || diagonal <= 0 || diagonal > 1e18)
        return mesh;
    m.diagonal = diagonal;
    m.chord = m.deflection > 0 ? m.deflection : diagonal * USUAL_CHORD;
    if (m.chord < diagonal * FINEST_CHORD) {
        m.coarser = std::max(m.coarser, diagonal * FINEST_CHORD / m.chord);
        m.chord = diagonal * FINEST_CHORD;
    }
    choose_origin(mesh, box, diagonal);
    BRepMesh_IncrementalMesh(shape, m.chord, false, CHORD_TURN, false);
    m.faces.clear();
    add_faces(m, shape);
    add_edges(m, mesh, shape);
    for (const auto &[key, f] : m.faces)
        put_face(mesh.groups[colour_of(f.face)], f, mesh.origin, diagonal);
    for (auto at = mesh.groups.begin(); at != mesh.groups.end();)
        at = at->second.indices.empty() ? mesh.groups.erase(at) : std::next(at);
    return mesh;
}

// --- the tree ----------------------------------------------------------------------------------------------

std::string text_of(const TDF_Label &label)
{
    Handle(TDataStd_Name) name;
    if (!label.FindAttribute(TDataStd_Name::GetID(), name))
        return "";
    const TCollection_ExtendedString &wide = name->Get();
    std::string                       out(static_cast<size_t>(wide.LengthOfCString()) + 1, '\0');
    char                             *at = &out[0];
    wide.ToUTF8CString(at);
    out.resize(std::strlen(out.c_str()));
    return out;
}

// Writers that know no name of an instance make one up: "NAUO12", "=>[0:1:1:2]".
bool is_made_up(const std::string &name)
{
    return name.empty() || name.compare(0, 4, "NAUO") == 0 || name.compare(0, 2, "=>") == 0 ||
           name.find_first_not_of("0123456789 ") == std::string::npos;
}

Colour colour_of_label(const XCAFDoc_ColorTool &colours, const TDF_Label &label)
{
    Quantity_ColorRGBA value;
    Colour             out;
    for (XCAFDoc_ColorType type : {XCAFDoc_ColorSurf, XCAFDoc_ColorGen}) {
        TDF_Label where;
        if (!XCAFDoc_ColorTool::GetColor(label, type, where) || !colours.GetColor(where, value))
            continue;
        double r, g, b;
        value.GetRGB().Values(r, g, b, Quantity_TOC_sRGB);
        out.there = true;
        out.rgba[0] = static_cast<float>(r);
        out.rgba[1] = static_cast<float>(g);
        out.rgba[2] = static_cast<float>(b);
        out.rgba[3] = value.Alpha();
        break;
    }
    return out;
}

void matrix_of(const TopLoc_Location &location, double out[16])
{
    const gp_Trsf t = location.Transformation();
    for (int column = 0; column < 4; column++)
        for (int row = 0; row < 4; row++)
            out[4 * column + row] = row < 3 ? t.Value(row + 1, column + 1) : column == 3;
}

using Pieces = NCollection_DataMap<TopoDS_Shape, TDF_Label, TopTools_ShapeMapHasher>;

struct Tree {
    Handle(XCAFDoc_ShapeTool) shapes;
    Handle(XCAFDoc_ColorTool) colours;
    Pieces                                                   pieces; // of the label at hand
    Mesher                                                   mesher;
    std::vector<Mesh>                                        meshes;
    std::vector<Node>                                        nodes;
    std::map<std::tuple<std::string, int, Colour>, uint32_t> made; // to meshes
};

uint32_t add_node(Tree &t, uint32_t parent, const std::string &name, const TopLoc_Location &location)
{
    Node n = {parent, STEP_NONE, name, {}};
    matrix_of(location, n.matrix);
    t.nodes.push_back(n);
    return static_cast<uint32_t>(t.nodes.size() - 1);
}

// What is drawn at a node; a mesh that was moved to its origin has its node moved back.
void hang(Tree &t, uint32_t node, uint32_t mesh)
{
    Node         &n = t.nodes[node];
    const double *o = t.meshes[mesh].origin;
    n.mesh = mesh;
    for (int row = 0; row < 3; row++)
        n.matrix[12 + row] += n.matrix[row] * o[0] + n.matrix[4 + row] * o[1] + n.matrix[8 + row] * o[2];
}

// The pieces of a label's shape that something is said of. Asking for them one by one walks all of them each time.
void find_pieces(Tree &t, const TDF_Label &label)
{
    TDF_LabelSequence subs;
    t.pieces.Clear();
    XCAFDoc_ShapeTool::GetSubShapes(label, subs);
    for (TDF_LabelSequence::Iterator at(subs); at.More(); at.Next()) {
        const TopoDS_Shape piece = XCAFDoc_ShapeTool::GetShape(at.Value());
        if (!piece.IsNull())
            t.pieces.Bind(piece, at.Value());
    }
}

// Of a piece of what the label is of.
Colour colour_of(const Tree &t, const TopoDS_Shape &piece, const Colour &otherwise)
{
    TDF_Label    sub;
    const Colour own = t.pieces.Find(piece, sub) ? colour_of_label(*t.colours, sub) : Colour();
    return own.there ? own : otherwise;
}

// `piece`: the how manieth solid of the label it is.
void draw(Tree &t, const TDF_Label &label, int piece, const TopoDS_Shape &shape, uint32_t node, const std::string &name,
          const Colour &colour)
{
    TCollection_AsciiString entry;
    TDF_Tool::Entry(label, entry);
    const auto key = std::make_tuple(std::string(entry.ToCString()), piece, colour);
    auto       found = t.made.find(key);
    if (found == t.made.end()) {
        Mesh     mesh = mesh_of(t.mesher, shape, [&](const TopoDS_Face &f) { return colour_of(t, f, colour); });
        uint32_t number = STEP_NONE;
        mesh.name = name;
        if (!mesh.empty()) {
            number = static_cast<uint32_t>(t.meshes.size());
            t.meshes.push_back(std::move(mesh));
        }
        found = t.made.emplace(key, number).first;
    }
    if (found->second != STEP_NONE)
        hang(t, node, found->second);
}

// One part a solid, unless there is something besides.
void add_shape(Tree &t, const TDF_Label &label, uint32_t node, const std::string &name, const Colour &colour)
{
    const TopoDS_Shape         shape = XCAFDoc_ShapeTool::GetShape(label);
    TopTools_IndexedMapOfShape solids;
    if (shape.IsNull())
        return;
    find_pieces(t, label);
    TopExp::MapShapes(shape, TopAbs_SOLID, solids);
    const bool together = solids.Extent() < 2 || TopExp_Explorer(shape, TopAbs_EDGE, TopAbs_SOLID).More();
    if (together) {
        const Colour own = solids.Extent() == 1 ? colour_of(t, solids(1), colour) : colour;
        draw(t, label, 0, shape, node, name, own);
        return;
    }
    for (int i = 1; i <= solids.Extent(); i++) {
        TDF_Label         sub;
        const std::string found = t.pieces.Find(solids(i), sub) ? text_of(sub) : "";
        const std::string own = is_made_up(found) ? name : found;
        draw(t, label, i, solids(i), add_node(t, node, own, TopLoc_Location()), own, colour_of(t, solids(i), colour));
    }
}

void add(Tree &t, const TDF_Label &label, uint32_t parent, const Colour &above, unsigned depth)
{
    if (depth > DEEPEST)
        throw Failure{STEP_DAMAGED, "assemblies stand within themselves"};
    TDF_Label       of = label;
    TopLoc_Location location;
    const bool      instance = XCAFDoc_ShapeTool::IsReference(label);
    if (instance) {
        location = XCAFDoc_ShapeTool::GetLocation(label);
        if (!XCAFDoc_ShapeTool::GetReferredShape(label, of))
            return;
    }
    std::string       name = instance ? text_of(label) : "";
    const Colour      own = instance ? colour_of_label(*t.colours, label) : Colour();
    const Colour      made = colour_of_label(*t.colours, of);
    const Colour      inherited = own.there ? own : made.there ? made : above;
    const std::string product = text_of(of);
    if (is_made_up(name))
        name = product;
    const uint32_t node = add_node(t, parent, name, location);
    if (XCAFDoc_ShapeTool::IsAssembly(of)) {
        TDF_LabelSequence parts;
        XCAFDoc_ShapeTool::GetComponents(of, parts);
        for (int i = 1; i <= parts.Length(); i++)
            add(t, parts.Value(i), node, inherited, depth + 1);
    } else {
        add_shape(t, of, node, product, inherited);
    }
}

void put_tree(const Answer &a, const Tree &t, const cad::File &file)
{
    const auto coarser = static_cast<float>(t.mesher.coarser);
    for (const std::string *text : {&file.unit, &file.title, &file.author, &file.organisation, &file.date})
        a.text(*text);
    a.bytes(&coarser, sizeof coarser);
    a.bytes(&file.losses, sizeof file.losses);
    a.number(static_cast<uint32_t>(t.meshes.size()));
    for (const Mesh &m : t.meshes)
        put_mesh(a, m);
    a.number(static_cast<uint32_t>(t.nodes.size()));
    for (const Node &n : t.nodes)
        put_node(a, n);
}

// --- the whole ---------------------------------------------------------------------------------------------

void prepare()
{
    try {
        Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
        cad::new_document()->Close();
        cad::prepare_step();
        cad::prepare_iges();
    } catch (...) {
        // Reading will say so.
    }
}

// What could not be drawn, since its unit makes it smaller than what OpenCASCADE takes for one place, or so large that
// its numbers have no such places any more. That is no damage.
void tell_size(const cad::File &file, const TDF_LabelSequence &roots)
{
    constexpr double smallest = 1e-3, largest = 1e15; // mm
    Bnd_Box          box;                             // of the vertices: tolerances are larger than such a model
    for (int i = 1; i <= roots.Length(); i++)
        for (TopExp_Explorer at(XCAFDoc_ShapeTool::GetShape(roots.Value(i)), TopAbs_VERTEX); at.More(); at.Next())
            box.Add(BRep_Tool::Pnt(TopoDS::Vertex(at.Current())));
    const bool has_vertices = !box.IsVoid(); // they go where all edges of the model are as long as nothing
    for (int i = 1; i <= roots.Length() && !has_vertices; i++)
        BRepBndLib::Add(XCAFDoc_ShapeTool::GetShape(roots.Value(i)), box, false);
    if (box.IsVoid() || file.unit.empty())
        return;
    const double size = std::sqrt(box.SquareExtent());
    char         message[160];
    std::snprintf(message, sizeof message, "%.40s, which makes the model %s%.3g mm large: %s than can be drawn",
                  file.unit.c_str(), has_vertices ? "" : "less than ", size, size < smallest ? "smaller" : "larger");
    if (size < smallest || size > largest)
        throw Failure{STEP_NO_SIZE, message};
}

void add_all(Tree &tree, const cad::File &file, const TDF_LabelSequence &roots)
{
    try {
        for (int i = 1; i <= roots.Length(); i++)
            add(tree, roots.Value(i), STEP_NONE, Colour(), 0);
        if (tree.meshes.empty())
            throw Failure{STEP_EMPTY, "nothing in the file can be drawn"};
    } catch (const Standard_OutOfMemory &) {
        throw;
    } catch (const Standard_Failure &) {
        tell_size(file, roots);
        throw;
    } catch (const Failure &f) {
        if (f.result == STEP_EMPTY)
            tell_size(file, roots);
        throw;
    }
}

void read_all(const step_request &request, const Answer &answer)
{
    const cad::File   file = request.kind == STEP_KIND_IGES ? cad::read_iges(request.bytes, request.size)
                                                            : cad::read_step(request.bytes, request.size);
    TDF_LabelSequence roots;
    Tree              tree;
    tree.shapes = XCAFDoc_DocumentTool::ShapeTool(file.document->Main());
    tree.colours = XCAFDoc_DocumentTool::ColorTool(file.document->Main());
    tree.mesher.deflection = request.deflection;
    tree.mesher.left = request.most_triangles;
    tree.shapes->GetFreeShapes(roots);
    add_all(tree, file, roots);
    put_tree(answer, tree, file);
}

step_result read(const step_request *request, step_put_fn put, void *to, char *message, size_t message_size)
{
    message[0] = '\0';
    try {
        read_all(*request, Answer(put, to));
        return STEP_DONE;
    } catch (const Failure &f) {
        std::snprintf(message, message_size, "%s", f.message.c_str());
        return f.result;
    } catch (const std::bad_alloc &) {
        return STEP_TOO_MUCH_MEMORY;
    } catch (const Standard_OutOfMemory &) {
        return STEP_TOO_MUCH_MEMORY;
    } catch (const Standard_Failure &f) {
        std::snprintf(message, message_size, "%s", f.GetMessageString());
        return STEP_DAMAGED;
    } catch (...) {
        return STEP_DAMAGED;
    }
}

} // namespace

Handle(TDocStd_Document) cad::new_document()
{
    Handle(TDocStd_Document) document;
    XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", document);
    return document;
}

extern "C" __attribute__((visibility("default")))
const step_module limner_step_module = {STEP_INTERFACE, OCC_VERSION_COMPLETE, prepare, read};
