// SPDX-License-Identifier: Apache-2.0
// cguide-check CERTIFICATE [--model model.json] [--guide guide.json] [--precise BITS]
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "cguide/exact/core/error.h"
#include "cguide/verify/check/check.h"

namespace {

constexpr int kProved = 0, kRefused = 1, kUsage = 2, kBadInput = 3, kIncomplete = 4, kInternal = 70;

constexpr const char* kHelp =
    "usage: cguide-check CERTIFICATE [--model model.json] [--guide guide.json] [--precise BITS]\n"
    "Re-checks every proof of a certificate with intervals and kinematics of its own.\n"
    "  --model FILE     the certificate must carry this canonical model, byte for byte\n"
    "                   (write it with: cguide model PROBLEM -o model.json)\n"
    "  --guide FILE     the certificate must be about the path of this guide\n"
    "  --precise BITS   MPFR numbers of so many bits (53 to 4096) instead of doubles\n"
    "exit: 0 the whole path is proved, 1 refused, 2 usage, 3 not a certificate,\n"
    "      4 what is there holds, but edges have no proof\n";

struct Arguments {
  std::string certificate;
  std::string model;
  std::string guide;
  int bits = 0;
};

std::optional<Arguments> Parse(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool has_value = word == "--model" || word == "--guide" || word == "--precise";
    if (has_value && i + 1 == argc) return std::nullopt;
    if (word == "--model") {
      arguments.model = argv[++i];
    } else if (word == "--guide") {
      arguments.guide = argv[++i];
    } else if (word == "--precise") {
      char* end = nullptr;
      const long bits = std::strtol(argv[++i], &end, 10);
      if (*end != '\0' || bits < 53 || bits > 4096) return std::nullopt;
      arguments.bits = static_cast<int>(bits);
    } else if (arguments.certificate.empty() && word.rfind("--", 0) != 0) {
      arguments.certificate = word;
    } else {
      return std::nullopt;
    }
  }
  if (arguments.certificate.empty()) return std::nullopt;
  return arguments;
}

/** At most so much is read, one byte more than the parser takes: devices may have no end. */
constexpr std::size_t kMostBytes = (256u << 20) + 1;

std::string ReadFile(const std::string& name) {
  std::ifstream file(name, std::ios::binary);
  std::string text;
  std::vector<char> block(1u << 20);
  while (file && text.size() < kMostBytes) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    text.append(block.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad() || (!file && !file.eof())) {
    throw cguide::Error(cguide::Error::Code::kIo, "the file cannot be read");
  }
  return text;
}

/** Says whether the certificate is about the path of a guide. A file that is no guide is named. */
bool IsAboutGuide(const cguide::check::Certificate& certificate, const std::string& file) {
  cguide::Path guide;
  try {
    guide = cguide::check::ParseGuidePath(ReadFile(file));
  } catch (const cguide::Error& e) {
    throw cguide::Error(e.code(), file + ": " + e.what());
  }
  const std::string difference = cguide::check::DifferenceOf(certificate.path, guide);
  if (difference.empty()) return true;
  std::cout << "refused: the certificate is about another path than " << file << ": " << difference
            << "\n";
  return false;
}

int Run(const Arguments& arguments) {
  const std::string text = ReadFile(arguments.certificate);
  const cguide::check::Certificate certificate = cguide::check::ParseCertificate(text);
  if (!arguments.model.empty() && !cguide::check::HasModelText(text, ReadFile(arguments.model))) {
    std::cout << "refused: the certificate is about another model than " << arguments.model << "\n";
    return kRefused;
  }
  if (!arguments.guide.empty() && !IsAboutGuide(certificate, arguments.guide)) return kRefused;
  const auto report = cguide::check::CheckCertificate(certificate, {arguments.bits});
  for (const std::string& line : report.refused) std::cout << "refused: " << line << "\n";
  if (!report.missing.empty()) {
    std::cout << "without proof: edges";
    for (const int edge : report.missing) std::cout << " " << edge;
    std::cout << "\n";
  }
  const cguide::check::Robustness& box = certificate.robust;
  if (!(box == cguide::check::Robustness{})) {
    std::cout << "for every model with friction less by up to " << box.friction
              << ", objects moved by up to " << box.pose << " m, centre of mass off by up to "
              << box.com << " m:\n";
  }
  std::cout << report.proved << " of " << report.edges << " edges proved"
            << (report.IsProved() ? "; the whole path stays in C_guide\n" : "\n");
  if (!report.refused.empty()) return kRefused;
  return report.missing.empty() ? kProved : kIncomplete;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::string(argv[1]) == "--help") {
    std::cout << kHelp;
    return kProved;
  }
  const std::optional<Arguments> arguments = Parse(argc, argv);
  if (!arguments) {
    std::cerr << kHelp;
    return kUsage;
  }
  try {
    return Run(*arguments);
  } catch (const cguide::Error& e) {
    std::cerr << "cguide-check: " << arguments->certificate << ": " << e.what() << "\n";
    return kBadInput;
  } catch (const std::exception& e) {
    std::cerr << "cguide-check: internal error: " << e.what() << "\n";
    return kInternal;
  }
}
