#pragma once

#include <string>

namespace cguide::numeric::io {

enum class MeshFormat { kStl, kObj, kDae, kOff };

/** A mesh file's bytes, fit to be given to the importer. */
struct GuardedMesh {
  std::string bytes;
  const char* hint;  ///< the importer's name of the format
};

/** Checks what the importer does not: announced counts against the size of the file, completeness
 of text STL, index ranges of OBJ and OFF, well-formedness of DAE. Takes a DAE's unit away and what
 OBJ says beside vertices and faces.
 @throws Error (kBadInput) beginning with `place`. */
GuardedMesh GuardMesh(std::string bytes, MeshFormat format, const std::string& place);

/** The faces of a COLLADA file as OBJ: triangles, polylists and polygons of the visual scene, each
 vertex moved by the transforms of its nodes in doubles and rounded to a float once. Up axis and
 unit are not looked at. Faces under a mirroring transform are turned, so that their outside stays
 outside.
 @throws Error (kBadInput) with the line: malformed XML, numbers, counts, indices or references;
 skins, strips, fans. */
std::string ObjFromDae(const std::string& bytes, const std::string& place);

}  // namespace cguide::numeric::io
