#include "step_write.h"

#include <BRepAdaptor_Curve.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Copy.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <IGESCAFControl_Writer.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_Static.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPControl_Controller.hxx>
#include <ShapeUpgrade_UnifySameDomain.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <UnitsMethods.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <cmath>
#include <cstdio>
#include <gp_Ax1.hxx>
#include <gp_Ax2.hxx>
#include <gp_Circ.hxx>

namespace
{

constexpr double INCH = 25.4;

struct Model {
    Handle(TDocStd_Document) document;
    Handle(XCAFDoc_ShapeTool) shapes;
    Handle(XCAFDoc_ColorTool) colours;
    Model()
    {
        STEPControl_Controller::Init();
        IGESControl_Controller::Init();
        XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", document);
        XCAFDoc_DocumentTool::SetLengthUnit(document, 1.0, UnitsMethods_LengthUnit_Millimeter);
        shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
        colours = XCAFDoc_DocumentTool::ColorTool(document->Main());
    }
    bool write_iges(const char *path, const char *unit, bool solid)
    {
        Interface_Static::SetCVal("write.iges.unit", unit);
        Interface_Static::SetIVal("write.iges.brep.mode", solid);
        IGESCAFControl_Writer writer;
        writer.SetColorMode(true);
        writer.SetNameMode(true);
        if (!writer.Transfer(document))
            return false;
        IGESData_GlobalSection header = writer.Model()->GlobalSection();
        header.SetAuthorName(new TCollection_HAsciiString("A. Writer"));
        header.SetCompanyName(new TCollection_HAsciiString("Works"));
        writer.Model()->SetGlobalSection(header);
        return writer.Write(path);
    }
    bool write(const char *path, const char *unit)
    {
        shapes->UpdateAssemblies();
        Interface_Static::SetCVal("write.step.unit", unit);
        STEPCAFControl_Writer writer;
        writer.SetColorMode(true);
        writer.SetNameMode(true);
        return writer.Transfer(document) && writer.Write(path) == IFSelect_RetDone;
    }
};

Quantity_Color srgb(double r, double g, double b)
{
    return Quantity_Color(r, g, b, Quantity_TOC_sRGB);
}

TopoDS_Shape moved(const TopoDS_Shape &shape, double x, double y, double z)
{
    gp_Trsf t;
    t.SetTranslation(gp_Vec(x, y, z));
    return shape.Moved(TopLoc_Location(t));
}

bool is_seam(const TopoDS_Edge &edge, const TopTools_ListOfShape &faces)
{
    for (const TopoDS_Shape &face : faces)
        if (BRep_Tool::IsClosed(edge, TopoDS::Face(face)))
            return true;
    return false;
}

void measure(const TopoDS_Shape &shape, step_truth *out)
{
    GProp_GProps volume, area;
    Bnd_Box      box;
    BRepGProp::VolumeProperties(shape, volume);
    BRepGProp::SurfaceProperties(shape, area);
    BRepBndLib::AddOptimal(shape, box, false, false);
    box.Get(out->low[0], out->low[1], out->low[2], out->high[0], out->high[1], out->high[2]);
    out->volume = volume.Mass();
    out->area = area.Mass();
    TopTools_IndexedDataMapOfShapeListOfShape edges;
    TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, edges);
    out->edges = out->point_count = 0;
    for (int i = 1; i <= edges.Extent(); i++) {
        const TopoDS_Edge edge = TopoDS::Edge(edges.FindKey(i));
        if (BRep_Tool::Degenerated(edge) || is_seam(edge, edges(i)))
            continue;
        BRepAdaptor_Curve curve(edge);
        out->edges++;
        for (int k = 0; k <= 100 && out->point_count < STEP_WRITE_POINTS; k++) {
            const double u = curve.FirstParameter() + (curve.LastParameter() - curve.FirstParameter()) * k / 100;
            const gp_Pnt p = curve.Value(u);
            p.Coord(out->points[3 * out->point_count], out->points[3 * out->point_count + 1],
                    out->points[3 * out->point_count + 2]);
            out->point_count++;
        }
    }
}

bool is_at(const TopoDS_Edge &edge, double x, double z)
{
    BRepAdaptor_Curve c(edge);
    const gp_Pnt      a = c.Value(c.FirstParameter()), b = c.Value(c.LastParameter());
    return std::hypot(a.X() - x, a.Z() - z) < 1e-6 && std::hypot(b.X() - x, b.Z() - z) < 1e-6;
}

void make_bracket(Model &m, step_truth *out)
{
    const TopoDS_Shape foot = BRepPrimAPI_MakeBox(40.0, 30.0, 8.0).Shape();
    const TopoDS_Shape wall = BRepPrimAPI_MakeBox(8.0, 30.0, 40.0).Shape();
    /* Faces in one plane are one. */
    ShapeUpgrade_UnifySameDomain united(BRepAlgoAPI_Fuse(foot, wall).Shape());
    united.Build();
    const TopoDS_Shape angle = united.Shape();
    const gp_Ax2       axis(gp_Pnt(STEP_WRITE_HOLE_X, STEP_WRITE_HOLE_Y, -1), gp_Dir(0, 0, 1));
    const TopoDS_Shape drilled =
        BRepAlgoAPI_Cut(angle, BRepPrimAPI_MakeCylinder(axis, STEP_WRITE_HOLE_RADIUS, 20).Shape()).Shape();
    BRepFilletAPI_MakeFillet fillet(drilled);
    for (TopExp_Explorer at(drilled, TopAbs_EDGE); at.More(); at.Next())
        if (is_at(TopoDS::Edge(at.Current()), 8, 8)) {
            fillet.Add(4.0, TopoDS::Edge(at.Current()));
            break;
        }
    TopoDS_Shape    whole = TopExp_Explorer(fillet.Shape(), TopAbs_SOLID).Current();
    const TDF_Label label = m.shapes->AddShape(whole, false);
    TDataStd_Name::Set(label, "bracket");
    for (TopExp_Explorer at(whole, TopAbs_FACE); at.More(); at.Next()) {
        Bnd_Box box;
        BRepBndLib::AddOptimal(at.Current(), box, false, false);
        if (box.CornerMax().Z() < 0.01)
            m.colours->SetColor(m.shapes->AddSubShape(label, at.Current()), srgb(1, 0, 0), XCAFDoc_ColorSurf);
    }
    measure(whole, out);
}

} // namespace

bool step_write_bracket(const char *path, step_truth *out)
{
    Model m;
    make_bracket(m, out);
    return m.write(path, "MM");
}

bool iges_write_bracket(const char *path, const char *unit, bool solid, step_truth *out)
{
    Model m;
    make_bracket(m, out);
    return m.write_iges(path, unit, solid);
}

bool iges_write_loose(const char *path, bool open)
{
    Model m;
    for (int box = 0; box < 2; box++) {
        const TopoDS_Shape whole = moved(BRepPrimAPI_MakeBox(10.0, 20.0, 30.0).Shape(), 40 * box, 0, 0);
        int                number = 0;
        for (TopExp_Explorer at(whole, TopAbs_FACE); at.More(); at.Next()) {
            if (box && open && ++number == 6)
                continue;
            BRepBuilderAPI_Copy copy(at.Current());
            const TDF_Label     label = m.shapes->AddShape(copy.Shape(), false);
            TDataStd_Name::Set(label, box ? "far" : "near");
            m.colours->SetColor(label, box ? srgb(0, 0, 1) : srgb(0, 1, 0), XCAFDoc_ColorSurf);
        }
    }
    m.shapes->AddShape(BRepBuilderAPI_MakeEdge(gp_Circ(gp_Ax2(gp_Pnt(0, 0, 60), gp_Dir(0, 0, 1)), 8)).Edge(), false);
    return m.write_iges(path, "MM", false);
}

bool step_write_assembly(const char *path)
{
    Model           m;
    const TDF_Label stand = m.shapes->NewShape(), inner = m.shapes->NewShape();
    const TDF_Label plate = m.shapes->AddShape(BRepPrimAPI_MakeBox(2 * INCH, 2 * INCH, 0.25 * INCH).Shape(), false);
    const TDF_Label pin = m.shapes->AddShape(BRepPrimAPI_MakeCylinder(0.25 * INCH, INCH).Shape(), false);
    TDataStd_Name::Set(stand, "stand");
    TDataStd_Name::Set(inner, "inner");
    TDataStd_Name::Set(plate, "plate");
    TDataStd_Name::Set(pin, "pin");
    m.colours->SetColor(plate, srgb(0.5, 0.5, 0.5), XCAFDoc_ColorSurf);
    m.colours->SetColor(pin, srgb(0, 0, 1), XCAFDoc_ColorSurf);
    gp_Trsf at, turned, far;
    at.SetTranslation(gp_Vec(0.5 * INCH, INCH, 0.25 * INCH));
    turned.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(1, 0, 0)), std::acos(-1.0) / 2);
    turned.SetTranslationPart(gp_Vec(1.5 * INCH, INCH, 0.25 * INCH));
    far.SetTranslation(gp_Vec(0, 0, 2 * INCH));
    m.shapes->AddComponent(stand, plate, TopLoc_Location());
    const TDF_Label left = m.shapes->AddComponent(stand, pin, TopLoc_Location(at));
    const TDF_Label right = m.shapes->AddComponent(stand, pin, TopLoc_Location(turned));
    m.shapes->AddComponent(inner, pin, TopLoc_Location());
    const TDF_Label group = m.shapes->AddComponent(stand, inner, TopLoc_Location(far));
    TDataStd_Name::Set(left, "left pin");
    TDataStd_Name::Set(right, "right pin");
    TDataStd_Name::Set(group, "inner");
    m.colours->SetColor(right, srgb(1, 0, 0), XCAFDoc_ColorSurf);
    return m.write(path, "INCH");
}

bool step_write_loose(const char *path)
{
    Model           m;
    BRep_Builder    builder;
    TopoDS_Compound both;
    builder.MakeCompound(both);
    builder.Add(both, BRepPrimAPI_MakeBox(10.0, 10.0, 10.0).Shape());
    builder.Add(both, moved(BRepPrimAPI_MakeBox(5.0, 5.0, 5.0).Shape(), 20, 0, 0));
    TDataStd_Name::Set(m.shapes->AddShape(both, false), "boxes");
    TopoDS_Compound wire;
    builder.MakeCompound(wire);
    builder.Add(wire, BRepBuilderAPI_MakeEdge(gp_Circ(gp_Ax2(gp_Pnt(0, 0, 30), gp_Dir(0, 0, 1)), 8)).Edge());
    TDataStd_Name::Set(m.shapes->AddShape(wire, false), "ring");
    return m.write(path, "MM");
}

bool step_write_halves(const char *path, double height)
{
    Model              m;
    const TopoDS_Shape left = BRepPrimAPI_MakeCylinder(gp_Ax2(), 5, height, std::acos(-1.0)).Shape();
    gp_Trsf            turn;
    turn.SetRotation(gp_Ax1(), std::acos(-1.0));
    const TopoDS_Shape right = left.Moved(TopLoc_Location(turn));
    TDataStd_Name::Set(m.shapes->AddShape(BRepAlgoAPI_Fuse(left, right).Shape(), false), "halves");
    return m.write(path, "MM");
}

bool step_write_many(const char *path, int count)
{
    Model           m;
    BRep_Builder    builder;
    TopoDS_Compound all;
    builder.MakeCompound(all);
    for (int i = 0; i < count; i++)
        builder.Add(all, moved(BRepPrimAPI_MakeCylinder(1.0, 1.0 + i % 3).Shape(), 3 * (i % 100), 3 * (i / 100), 0));
    m.shapes->AddShape(all, false);
    return m.write(path, "MM");
}
