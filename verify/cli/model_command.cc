#include <iostream>

#include "cguide/numeric/io/guide_io.h"
#include "cguide/numeric/io/problem_reader.h"
#include "cguide/verify/cli/commands.h"
#include "cguide/verify/cli/console.h"

namespace cguide::cli {

int RunModel(const ModelArguments& arguments) {
  if (!arguments.output.empty()) RequireWritable(arguments.output);
  const numeric::Problem problem = numeric::io::ReadProblem(arguments.problem);
  Warn(arguments.common, problem.warnings);
  const std::string text = numeric::io::WriteModel(problem.model);
  if (arguments.output.empty()) {
    std::cout << text;
    return kExitOk;
  }
  numeric::io::WriteFileAtomically(arguments.output, text);
  std::cout << arguments.output << ": " << problem.model_digest << '\n';
  return kExitOk;
}

}  // namespace cguide::cli
