#pragma once

#include <string>

namespace cguide::numeric::io {

enum class MeshFormat { kStl, kObj, kDae, kOff };

/** A mesh file's bytes, fit to be given to the importer. */
struct GuardedMesh {
  std::string bytes;
  const char* hint;  ///< the importer's name of the format
};

/** Checks everything the importer leaves unchecked, so that it sees sound files only: the size of
 binary STL, the grammar of text STL, numbers, counts and index ranges of OBJ, OFF and DAE. Takes
 away what these say beside vertices and faces; text STL and DAE become OBJ.
 @throws Error (kBadInput) beginning with `place`, with the line where there are lines. */
GuardedMesh GuardMesh(std::string bytes, MeshFormat format, const std::string& place);

/** The faces of a COLLADA file as OBJ: triangles, polylists and polygons of the visual scene, each
 vertex moved by the transforms of its nodes in doubles and rounded to a float once. Up axis and
 unit are not looked at. Faces under a mirroring transform are turned, so that their outside stays
 outside.
 @throws Error (kBadInput) with the line: malformed XML, numbers, counts, indices or references;
 skins, strips, fans. */
std::string ObjFromDae(const std::string& bytes, const std::string& place);

}  // namespace cguide::numeric::io
