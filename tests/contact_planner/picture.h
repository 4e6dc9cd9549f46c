#pragma once

#include <string>
#include <vector>

#include "search.h"

namespace contact_planner {

/** One search to draw. */
struct Drawing {
  std::string title;
  const SearchResult* result = nullptr;
};

/** An SVG page, a row for each search: the room from above and from the side (x to the right, y or
 z up), the root at every stance expanded (dots), the root's track to the last stance (line), and
 the contacts on the way: soles as outlines, points as rings. */
std::string Picture(const Setting& setting, const std::vector<cguide::Configuration>& guide,
                    const std::vector<Drawing>& drawings);

}  // namespace contact_planner
