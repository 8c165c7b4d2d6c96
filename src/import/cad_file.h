// Inside of the module with OpenCASCADE (step_module.cpp): files to documents of OpenCASCADE, one reader a format.
#ifndef LIMNER_IMPORT_CAD_FILE_H
#define LIMNER_IMPORT_CAD_FILE_H

#include <istream>
#include <streambuf>
#include <string>

#include <TDocStd_Document.hxx>

#include "import/step_module.h"

namespace cad
{

struct Failure {
    step_result result;
    std::string message;
};

struct File {
    Handle(TDocStd_Document) document;
    std::string unit; // of length, as the file calls it; coordinates are millimetres
    std::string title, author, organisation, date;
    step_losses losses = {0, 0, 0, 0, 0};
};

// Bytes as a stream, without a copy.
class Bytes : public std::streambuf
{
  public:
    Bytes(const unsigned char *bytes, size_t size)
    {
        char *at = const_cast<char *>(reinterpret_cast<const char *>(bytes));
        setg(at, at, at + size);
    }
};

Handle(TDocStd_Document) new_document();

// Open what the library wants to open, before the fence.
void prepare_step();
void prepare_iges();

// Throw Failure, and what OpenCASCADE throws.
File read_step(const unsigned char *bytes, size_t size);
// Loose faces, as most writers of IGES leave them, come sewn: bodies where they close, shells where they do not.
File read_iges(const unsigned char *bytes, size_t size);

} // namespace cad

#endif
