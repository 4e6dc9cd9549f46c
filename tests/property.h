#pragma once

#include <rapidcheck.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <sstream>
#include <string>
#include <utility>

namespace cguide::test {

/** Checks a property of generated values with rapidcheck: a callable whose arguments are generated
 or that draws them with `*gen`, and whose RC_ASSERT fail it. The seed is fixed, so that every run
 sees the same cases; RC_PARAMS in the environment ("seed=... max_success=...") overrules it. A
 counterexample is shrunk and fails the test with the text that rapidcheck writes about it. */
template <typename Property>
void CheckProperty(const std::string& sentence, Property&& property, int cases = 300) {
  constexpr const char* kFixed = "seed=20261126";
  setenv("RC_PARAMS", kFixed, 0);  // read by the library once, and named in its output
  rc::detail::TestParams params = rc::detail::configuration().testParams;
  if (std::string(std::getenv("RC_PARAMS")) == kFixed) params.maxSuccess = cases;
  const auto result = rc::detail::checkTestable(
      std::forward<Property>(property), rc::detail::TestMetadata{sentence, sentence}, params);
  if (result.template is<rc::detail::SuccessResult>()) {
    SUCCEED(sentence);
    return;
  }
  std::ostringstream text;
  rc::detail::printResultMessage(result, text);
  FAIL(sentence << "\n" << text.str());
}

}  // namespace cguide::test
