// STEP to a document of OpenCASCADE.
#include "import/cad_file.h"

#include <APIHeaderSection_MakeHeader.hxx>
#include <Interface_Check.hxx>
#include <Interface_CheckIterator.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <StepData_StepModel.hxx>
#include <StepShape_Face.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <Transfer_Binder.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

namespace
{

std::string unit_of(STEPCAFControl_Reader &reader)
{
    TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
    reader.ChangeReader().FileUnits(lengths, angles, solid_angles);
    return lengths.IsEmpty() ? "" : lengths.First().ToCString();
}

// What the file names and cannot be had: OpenCASCADE draws the rest without a word.
step_losses losses_of(STEPCAFControl_Reader &reader)
{
    const Handle(XSControl_WorkSession) session = reader.Reader().WS();
    const Handle(StepData_StepModel) model = Handle(StepData_StepModel)::DownCast(session->Model());
    const Handle(Transfer_TransientProcess) transfer = session->TransferReader()->TransientProcess();
    step_losses losses = {0, 0, 0, 0, 0};
    if (model.IsNull() || transfer.IsNull())
        return losses;
    Interface_CheckIterator checks = session->ModelCheckList(Standard_False);
    for (checks.Start(); checks.More(); checks.Next())
        if (checks.Value()->HasFailed() && losses.damaged++ == 0 && checks.Number() > 0)
            losses.first_damaged = static_cast<uint32_t>(model->IdentLabel(model->Value(checks.Number())));
    for (int i = 1; i <= model->NbEntities(); i++) {
        const Handle(Standard_Transient) entity = model->Value(i);
        if (!entity->IsKind(STANDARD_TYPE(StepShape_Face)))
            continue;
        losses.faces++;
        // A face that nothing uses has no binder; one that was tried has one, and a result if it came to something.
        const Handle(Transfer_Binder) binder = transfer->Find(entity);
        if (!binder.IsNull() && !binder->HasResult() && losses.lost++ == 0)
            losses.first_lost = static_cast<uint32_t>(model->IdentLabel(entity));
    }
    return losses;
}

std::string text_of(const Handle(TCollection_HAsciiString) & text)
{
    return text.IsNull() ? "" : text->ToCString();
}

// FILE_NAME of the header.
void take_header(STEPCAFControl_Reader &reader, cad::File &out)
{
    const Handle(StepData_StepModel) model = Handle(StepData_StepModel)::DownCast(reader.Reader().WS()->Model());
    if (model.IsNull())
        return;
    APIHeaderSection_MakeHeader header(model);
    if (!header.HasFn())
        return;
    out.title = text_of(header.Name());
    out.date = text_of(header.TimeStamp());
    if (header.NbAuthor() > 0)
        out.author = text_of(header.AuthorValue(1));
    if (header.NbOrganization() > 0)
        out.organisation = text_of(header.OrganizationValue(1));
}

} // namespace

void cad::prepare_step()
{
    STEPCAFControl_Reader reader;
}

cad::File cad::read_step(const unsigned char *data, size_t size)
{
    Bytes                 bytes(data, size);
    std::istream          stream(&bytes);
    STEPCAFControl_Reader reader;
    File                  out;
    out.document = new_document();
    reader.SetColorMode(true);
    reader.SetNameMode(true);
    reader.SetLayerMode(false);
    if (reader.ChangeReader().ReadStream("model", stream) != IFSelect_RetDone)
        throw Failure{STEP_DAMAGED, "this is no STEP data that can be read"};
    out.unit = unit_of(reader);
    take_header(reader, out);
    if (!reader.Transfer(out.document))
        throw Failure{STEP_EMPTY, "nothing in the file can be drawn"};
    out.losses = losses_of(reader);
    return out;
}
