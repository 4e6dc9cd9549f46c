#pragma once

#include <exception>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "cguide/exact/core/error.h"

namespace cguide::numeric::io {

/** All bytes of a regular file. @throws Error (kIo) that names the file where it is missing, a
 folder, unreadable or larger than `limit` bytes. */
std::string ReadFileBytes(const std::filesystem::path& file, std::size_t limit);

/** Likewise, and refuses what is no UTF-8 text (kBadInput): NUL and other control bytes, broken
 sequences; the message names the line. */
std::string ReadTextFile(const std::filesystem::path& file, std::size_t limit);

/** Whether the bytes are well-formed UTF-8 (RFC 3629: no overlong forms, no surrogates). */
bool IsUtf8(std::string_view bytes);

/** The candidate with the smallest edit distance to `word` (the first of several); empty where
 there is no candidate. */
std::string NearestName(std::string_view word, const std::vector<std::string>& candidates);

/** The sentence for a word that is none of `words`: the nearest one, then all of them. */
std::string UnknownWord(std::string_view word, const std::vector<std::string>& words);

/** "a, b, c", cut after `limit` items. */
std::string Join(const std::vector<std::string>& items, std::size_t limit = 40);

/** A short printable form of user text for a message: quoted, control bytes replaced, cut. */
std::string Quote(std::string_view text);

/** One line cut at the commas, blanks around the fields removed. */
std::vector<std::string_view> CutAtCommas(std::string_view line);

/** The double nearest to the decimal text, which must be a finite number and nothing else. No
 locale. Empty string in `*why` on success, else the reason ("is not a number", "is too large ...").
 */
double ParseDouble(std::string_view text, std::string* why);

/** The shortest decimal that reads back as the same double; "-0.0" keeps its sign in JSON readers
 that take "-0" for an integer. Requires x finite. */
std::string ShortestDouble(double x);

/** Runs `read`; an exception of a library leaves as Error (kInternal) that names the file. */
template <typename Function>
auto GuardedRead(const std::filesystem::path& file, Function read) {
  try {
    return read();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    throw Error(Error::Code::kInternal, file.string() + ": reading failed in a library (" +
                                            e.what() + "); please report the file");
  }
}

}  // namespace cguide::numeric::io
