#include "dxf_read.h"

#include <cstdlib>
#include <cstring>
#include <dl_creationadapter.h>
#include <dl_dxf.h>
#include <string>
#include <vector>

namespace
{

class collector : public DL_CreationAdapter
{
  public:
    std::vector<dxf_entity> entities;
    std::vector<double>     numbers, bulges;
    size_t                  layers = 0;

    void addLayer(const DL_LayerData &) override
    {
        layers++;
    }

    void addLine(const DL_LineData &line) override
    {
        begin(DXF_LINE);
        point(line.x1, line.y1);
        point(line.x2, line.y2);
    }

    void addPolyline(const DL_PolylineData &line) override
    {
        begin(DXF_POLYLINE);
        entities.back().closed = (line.flags & 1) != 0;
    }

    void addVertex(const DL_VertexData &vertex) override
    {
        point(vertex.x, vertex.y);
        bulges.back() = vertex.bulge;
    }

    void addCircle(const DL_CircleData &circle) override
    {
        begin(DXF_CIRCLE);
        point(circle.cx, circle.cy);
        entities.back().size = circle.radius;
    }

    void addArc(const DL_ArcData &arc) override
    {
        begin(DXF_ARC);
        point(arc.cx, arc.cy);
        entities.back().size = arc.radius;
        entities.back().angles[0] = arc.angle1;
        entities.back().angles[1] = arc.angle2;
    }

    void addEllipse(const DL_EllipseData &ellipse) override
    {
        begin(DXF_ELLIPSE);
        point(ellipse.cx, ellipse.cy);
        point(ellipse.mx, ellipse.my);
        entities.back().size = ellipse.ratio;
        entities.back().angles[0] = ellipse.angle1;
        entities.back().angles[1] = ellipse.angle2;
    }

    void addSpline(const DL_SplineData &) override
    {
        begin(DXF_SPLINE);
    }

    void addControlPoint(const DL_ControlPointData &control) override
    {
        point(control.x, control.y);
    }

    void addKnot(const DL_KnotData &) override
    {
        entities.back().knots++;
    }

    void addText(const DL_TextData &text) override
    {
        begin(DXF_TEXT);
        point(text.ipx, text.ipy);
        entities.back().size = text.height;
        std::strncpy(entities.back().words, text.text.c_str(), sizeof entities.back().words - 1);
    }

  private:
    void begin(dxf_kind kind)
    {
        dxf_entity e;
        std::memset(&e, 0, sizeof e);
        e.kind = kind;
        e.first = numbers.size() / 2;
        std::strncpy(e.line_type, getAttributes().getLinetype().c_str(), sizeof e.line_type - 1);
        e.pattern_scale = getAttributes().getLinetypeScale();
        std::strncpy(e.layer, getAttributes().getLayer().c_str(), sizeof e.layer - 1);
        entities.push_back(e);
    }

    void point(double x, double y)
    {
        numbers.push_back(x);
        numbers.push_back(y);
        bulges.push_back(0);
        entities.back().count++;
    }
};

} // namespace

bool dxf_read(dxf_file *out, const char *path)
{
    collector found;
    DL_Dxf    reader;
    if (!reader.in(path, &found))
        return false;
    out->entity_count = found.entities.size();
    out->point_count = found.numbers.size() / 2;
    out->layer_count = found.layers;
    out->entities = static_cast<dxf_entity *>(std::malloc((found.entities.size() + 1) * sizeof(dxf_entity)));
    out->points = static_cast<double(*)[2]>(std::malloc((found.numbers.size() + 2) * sizeof(double)));
    std::memcpy(out->entities, found.entities.data(), found.entities.size() * sizeof(dxf_entity));
    out->bulges = static_cast<double *>(std::malloc((found.bulges.size() + 1) * sizeof(double)));
    std::memcpy(out->bulges, found.bulges.data(), found.bulges.size() * sizeof(double));
    std::memcpy(out->points, found.numbers.data(), found.numbers.size() * sizeof(double));
    return true;
}

void dxf_release(dxf_file *f)
{
    std::free(f->entities);
    std::free(f->points);
    std::free(f->bulges);
}
