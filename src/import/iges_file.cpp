// IGES to a document of OpenCASCADE. Its files are heaps of faces, of which some writers know that they are solids and
// most do not, in groups at best: what touches is sewn together, and becomes a solid where it closes.
#include "import/cad_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <IGESBasic_SingularSubfigure.hxx>
#include <IGESBasic_SubfigureDef.hxx>
#include <IGESCAFControl.hxx>
#include <IGESControl_Reader.hxx>
#include <IGESData_IGESModel.hxx>
#include <IGESGeom_BoundedSurface.hxx>
#include <IGESGeom_TrimmedSurface.hxx>
#include <IGESGraph_Color.hxx>
#include <IGESSolid_Face.hxx>
#include <Interface_Check.hxx>
#include <Interface_CheckIterator.hxx>
#include <NCollection_DataMap.hxx>
#include <Quantity_Color.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_LabelMap.hxx>
#include <TDataStd_Name.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

namespace
{

// Edges no farther apart than this share of the diagonal are one; or than the file says that it is exact to, as far as
// that is not more than the larger share.
constexpr double   SEWN = 1e-5, SEWN_MOST = 1e-3;
constexpr unsigned DEEPEST = 512;

// What the file says of an entity that became a shape.
struct Said {
    std::string    name;
    bool           coloured = false;
    Quantity_Color colour;
};

using Sayings = NCollection_DataMap<TopoDS_Shape, Said, TopTools_ShapeMapHasher>;

std::string text_of(const Handle(TCollection_HAsciiString) & text)
{
    std::string       out = text.IsNull() ? "" : text->ToCString();
    const std::size_t from = out.find_first_not_of(' '), to = out.find_last_not_of(' ');
    return from == std::string::npos ? "" : out.substr(from, to - from + 1);
}

// Its own, or for an instance that of what it shows.
std::string name_of(const Handle(IGESData_IGESEntity) & entity)
{
    std::string name = entity->HasName() ? text_of(entity->NameValue()) : "";
    const Handle(IGESBasic_SubfigureDef) definition = Handle(IGESBasic_SubfigureDef)::DownCast(entity);
    const Handle(IGESBasic_SingularSubfigure) instance = Handle(IGESBasic_SingularSubfigure)::DownCast(entity);
    if (name.empty() && !definition.IsNull())
        return text_of(definition->Name());
    return name.empty() && !instance.IsNull() && !instance->Subfigure().IsNull()
               ? text_of(instance->Subfigure()->Name())
               : name;
}

bool colour_of(const Handle(IGESData_IGESEntity) & entity, Quantity_Color &out)
{
    if (entity->DefColor() == IGESData_DefValue) {
        if (entity->RankColor() < 1 || entity->RankColor() > 8)
            return false;
        out = IGESCAFControl::DecodeColor(entity->RankColor());
        return true;
    }
    const Handle(IGESGraph_Color) colour = Handle(IGESGraph_Color)::DownCast(entity->Color());
    if (entity->DefColor() != IGESData_DefReference || colour.IsNull())
        return false;
    double rgb[3];
    colour->RGBIntensity(rgb[0], rgb[1], rgb[2]);
    for (double &value : rgb)
        value = value > 0 ? std::min(value / 100, 1.0) : 0;
    out = Quantity_Color(rgb[0], rgb[1], rgb[2], Quantity_TOC_sRGB);
    return true;
}

bool is_face(const Handle(IGESData_IGESEntity) & entity)
{
    return entity->IsKind(STANDARD_TYPE(IGESGeom_TrimmedSurface)) ||
           entity->IsKind(STANDARD_TYPE(IGESGeom_BoundedSurface)) || entity->IsKind(STANDARD_TYPE(IGESSolid_Face));
}

// Numbers are those of the directory: two lines an entity.
uint32_t number_of(const Handle(IGESData_IGESModel) & model, const Handle(IGESData_IGESEntity) & entity)
{
    return static_cast<uint32_t>(2 * model->Number(entity) - 1);
}

class Reading
{
  public:
    explicit Reading(cad::File &out) : out_(out)
    {
    }
    void read(const unsigned char *data, size_t size);

  private:
    void      take_globals();
    void      listen();
    void      find_losses();
    TDF_Label put(const TopoDS_Shape &shape, const Said &said);
    void      colour(const TDF_Label &label, const TopoDS_Shape &faces, const Said &above,
                     const BRepBuilderAPI_Sewing *sewn);
    // A piece of an assembly, or of the file, and where it is.
    struct Piece {
        TDF_Label       label;
        TopLoc_Location location;
    };
    std::vector<Piece> pieces_of(const TopoDS_Shape &shape, const Said &above, unsigned depth);
    void               sew(const TopoDS_Shape &loose, const Said &said, std::vector<Piece> &to);
    Said               said_of(const TopoDS_Shape &shape, const Said &above) const;
    double             tolerance_of(const TopoDS_Shape &shape) const;

    cad::File         &out_;
    IGESControl_Reader reader_;
    Handle(IGESData_IGESModel) model_;
    Handle(Transfer_TransientProcess) transfer_;
    Handle(XCAFDoc_ShapeTool) shapes_;
    Handle(XCAFDoc_ColorTool) colours_;
    Sayings                                                               sayings_;
    NCollection_DataMap<TopoDS_Shape, TDF_Label, TopTools_ShapeMapHasher> made_; // of groups, where they lie unmoved
    double                                                                exact_ = 0; // mm; of the file
};

void Reading::take_globals()
{
    const IGESData_GlobalSection &global = model_->GlobalSection();
    out_.unit = text_of(global.UnitName());
    out_.title = text_of(global.SendName());
    out_.author = text_of(global.AuthorName());
    out_.organisation = text_of(global.CompanyName());
    out_.date = text_of(global.Date());
    exact_ = global.Resolution() * global.UnitValue();
}

void Reading::listen()
{
    for (int i = 1; i <= model_->NbEntities(); i++) {
        const Handle(IGESData_IGESEntity) entity = model_->Entity(i);
        const TopoDS_Shape shape = TransferBRep::ShapeResult(transfer_, entity);
        Said               said;
        if (shape.IsNull())
            continue;
        said.name = name_of(entity);
        said.coloured = colour_of(entity, said.colour);
        if (Said *known = sayings_.ChangeSeek(shape)) {
            // A group of one thing is that thing.
            known->name = known->name.empty() ? said.name : known->name;
            if (!known->coloured && said.coloured) {
                known->coloured = true;
                known->colour = said.colour;
            }
        } else if (said.coloured || !said.name.empty()) {
            sayings_.Bind(shape, said);
        }
    }
}

void Reading::find_losses()
{
    step_losses            &losses = out_.losses;
    Interface_CheckIterator checks = transfer_->CheckList(Standard_False);
    for (checks.Start(); checks.More(); checks.Next())
        if (checks.Value()->HasFailed() && losses.damaged++ == 0 && checks.Number() > 0)
            losses.first_damaged = static_cast<uint32_t>(2 * checks.Number() - 1);
    for (int i = 1; i <= model_->NbEntities(); i++) {
        const Handle(IGESData_IGESEntity) entity = model_->Entity(i);
        if (!is_face(entity))
            continue;
        losses.faces++;
        if (TransferBRep::ShapeResult(transfer_, entity).IsNull() && losses.lost++ == 0)
            losses.first_lost = number_of(model_, entity);
    }
}

Said Reading::said_of(const TopoDS_Shape &shape, const Said &above) const
{
    Said        out = above;
    const Said *own = sayings_.Seek(shape);
    if (!own)
        return out;
    if (!own->name.empty())
        out.name = own->name;
    if (own->coloured) {
        out.coloured = true;
        out.colour = own->colour;
    }
    return out;
}

TDF_Label Reading::put(const TopoDS_Shape &shape, const Said &said)
{
    const TDF_Label label = shapes_->AddShape(shape, Standard_False);
    if (!said.name.empty())
        TDataStd_Name::Set(label, said.name.c_str());
    if (said.coloured)
        colours_->SetColor(label, said.colour, XCAFDoc_ColorSurf);
    return label;
}

// Faces that have a colour of their own. `sewn`: what became of them; NULL: nothing.
void Reading::colour(const TDF_Label &label, const TopoDS_Shape &faces, const Said &above,
                     const BRepBuilderAPI_Sewing *sewn)
{
    for (TopExp_Explorer at(faces, TopAbs_FACE); at.More(); at.Next()) {
        const Said own = said_of(at.Current(), Said());
        if (!own.coloured || (above.coloured && own.colour == above.colour))
            continue;
        const TopoDS_Shape now = sewn && sewn->IsModified(at.Current()) ? sewn->Modified(at.Current()) : at.Current();
        for (TopExp_Explorer piece(now, TopAbs_FACE); piece.More(); piece.Next()) {
            const TDF_Label sub = shapes_->AddSubShape(label, piece.Current());
            if (!sub.IsNull())
                colours_->SetColor(sub, own.colour, XCAFDoc_ColorSurf);
        }
    }
}

double Reading::tolerance_of(const TopoDS_Shape &shape) const
{
    Bnd_Box box;
    BRepBndLib::Add(shape, box, Standard_False);
    const double diagonal = box.IsVoid() ? 0 : std::sqrt(box.SquareExtent());
    return std::max(std::min(std::max(exact_, SEWN * diagonal), SEWN_MOST * diagonal), 1e-7);
}

// A shell as a solid, if it closes.
TopoDS_Shape closed(const TopoDS_Shape &shell)
{
    TopoDS_Solid solid;
    BRep_Builder builder;
    if (shell.ShapeType() != TopAbs_SHELL || !BRep_Tool::IsClosed(shell))
        return shell;
    builder.MakeSolid(solid);
    builder.Add(solid, shell);
    BRepLib::OrientClosedSolid(solid);
    return solid;
}

// One piece each: what hangs together; and of what does not, faces and wires, one for all.
void Reading::sew(const TopoDS_Shape &loose, const Said &said, std::vector<Piece> &to)
{
    BRep_Builder          builder;
    TopoDS_Compound       rest;
    bool                  any = false;
    BRepBuilderAPI_Sewing sewing(tolerance_of(loose));
    builder.MakeCompound(rest);
    sewing.SetNonManifoldMode(Standard_False);
    for (TopExp_Explorer at(loose, TopAbs_FACE); at.More(); at.Next())
        sewing.Add(at.Current());
    sewing.Perform();
    std::vector<TopoDS_Shape> bodies;
    for (TopExp_Explorer at(sewing.SewedShape(), TopAbs_SHELL); at.More(); at.Next())
        bodies.push_back(closed(at.Current()));
    for (TopExp_Explorer at(sewing.SewedShape(), TopAbs_FACE, TopAbs_SHELL); at.More(); at.Next(), any = true)
        builder.Add(rest, at.Current());
    for (TopExp_Explorer at(loose, TopAbs_EDGE, TopAbs_FACE); at.More(); at.Next(), any = true)
        builder.Add(rest, at.Current());
    if (any)
        bodies.push_back(rest);
    for (const TopoDS_Shape &body : bodies) {
        const TDF_Label label = put(body, said);
        colour(label, loose, said, &sewing);
        to.push_back({label, TopLoc_Location()});
    }
}

// What a group consists of: groups and solids as they are, loose faces and wires sewn.
std::vector<Reading::Piece> Reading::pieces_of(const TopoDS_Shape &group, const Said &above, unsigned depth)
{
    std::vector<Piece> out;
    TopoDS_Compound    loose;
    BRep_Builder       builder;
    bool               any = false;
    if (depth > DEEPEST)
        throw cad::Failure{STEP_DAMAGED, "groups stand within themselves"};
    builder.MakeCompound(loose);
    for (TopoDS_Iterator at(group, Standard_False, Standard_False); at.More(); at.Next()) {
        const TopoDS_Shape   &shape = at.Value();
        const TopLoc_Location location = shape.Location();
        const Said            said = said_of(shape, above);
        TDF_Label             label;
        if (shape.ShapeType() > TopAbs_SOLID) {
            builder.Add(loose, shape);
            any = true;
            continue;
        }
        const TopoDS_Shape unmoved = shape.Located(TopLoc_Location());
        if (made_.Find(unmoved, label)) {
            out.push_back({label, location});
            continue;
        }
        if (shape.ShapeType() == TopAbs_SOLID) {
            label = put(unmoved, said);
            colour(label, unmoved, said, nullptr);
        } else {
            const std::vector<Piece> inside = pieces_of(unmoved, said, depth + 1);
            if (inside.empty())
                continue;
            label = inside.front().label;
            if (inside.size() > 1 || !inside.front().location.IsIdentity()) {
                label = shapes_->NewShape();
                if (!said.name.empty())
                    TDataStd_Name::Set(label, said.name.c_str());
                for (const Piece &piece : inside)
                    shapes_->AddComponent(label, piece.label, piece.location);
            }
        }
        made_.Bind(unmoved, label);
        out.push_back({label, location});
    }
    if (any)
        sew(loose, above, out);
    return out;
}

void Reading::read(const unsigned char *data, size_t size)
{
    // OpenCASCADE reads files, which behind the fence cannot be opened, or standard input, which nobody has there.
    std::FILE *in = fmemopen(const_cast<unsigned char *>(data), size, "r");
    std::FILE *before = stdin;
    if (!in)
        throw std::bad_alloc();
    stdin = in;
    const IFSelect_ReturnStatus status = reader_.ReadFile("");
    stdin = before;
    model_ = Handle(IGESData_IGESModel)::DownCast(reader_.WS()->Model());
    if (status != IFSelect_RetDone || model_.IsNull() || model_->NbEntities() == 0)
        throw cad::Failure{STEP_DAMAGED, "this is no IGES data that can be read"};
    take_globals();
    reader_.TransferRoots();
    transfer_ = reader_.WS()->TransferReader()->TransientProcess();
    find_losses();
    listen();
    out_.document = cad::new_document();
    shapes_ = XCAFDoc_DocumentTool::ShapeTool(out_.document->Main());
    colours_ = XCAFDoc_DocumentTool::ColorTool(out_.document->Main());
    XCAFDoc_ShapeTool::SetAutoNaming(Standard_False);
    TopoDS_Compound whole;
    BRep_Builder    builder;
    builder.MakeCompound(whole);
    for (int i = 1; i <= reader_.NbShapes(); i++)
        builder.Add(whole, reader_.Shape(i));
    const std::vector<Piece> pieces = pieces_of(whole, Said(), 0);
    // What is moved, or there several times, is an instance of the file as a whole.
    TDF_LabelMap seen;
    bool         plain = true;
    for (const Piece &piece : pieces)
        plain = plain && piece.location.IsIdentity() && seen.Add(piece.label);
    if (plain || pieces.empty())
        return;
    const TDF_Label file = shapes_->NewShape();
    for (const Piece &piece : pieces)
        shapes_->AddComponent(file, piece.label, piece.location);
}

} // namespace

void cad::prepare_iges()
{
    IGESControl_Reader reader;
}

cad::File cad::read_iges(const unsigned char *bytes, size_t size)
{
    File    out;
    Reading reading(out);
    reading.read(bytes, size);
    return out;
}
