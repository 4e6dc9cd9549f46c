#include <chrono>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/file_internal.h"
#include "cguide/numeric/io/guide_io.h"
#include "cguide/numeric/io/problem_reader.h"
#include "cguide/verify/certificate_writer.h"
#include "cguide/verify/cli/commands.h"
#include "cguide/verify/cli/console.h"
#include "cguide/verify/cli/list_outcome.h"
#include "cguide/verify/cli/robust_option.h"
#include "cguide/verify/cli/subject.h"
#include "cguide/verify/cli/version.h"
#include "cguide/verify/whole_report.h"

namespace cguide::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxBytes = 256u << 20;

/** Problems that were read already: most lists have many paths and few rooms. */
class ProblemCache {
 public:
  /** @throws as numeric::io::ReadProblem. */
  numeric::Problem Read(const fs::path& file) {
    const auto known = problems_.find(file.string());
    if (known != problems_.end()) return known->second;
    return problems_[file.string()] = numeric::io::ReadProblem(file);
  }

  /** The user has seen the warnings, and will not again. */
  void ForgetWarnings(const fs::path& file) { problems_[file.string()].warnings.clear(); }

 private:
  std::map<std::string, numeric::Problem> problems_;
};

/** The audit of one shard of a list. */
struct ListRun {
  AuditArguments arguments;
  fs::path folder;  ///< that takes the results
  std::vector<verify::ListedPath> listed;
  std::vector<verify::ListedInput> inputs;  ///< of every path, other shards' too
  ProblemCache problems;
  verify::ShardManifest manifest;  ///< but for its audits
  std::map<int, verify::ListedAudit> audits;
};

/** Works from the folder of the list, so that all names in reports, messages and digests are
 relative to the list, wherever the program was started: shards may run on several machines. */
void EnterFolderOfList(AuditArguments* arguments) {
  const fs::path list = fs::absolute(arguments->list);
  const fs::path start = fs::current_path();
  std::error_code code;
  fs::current_path(list.parent_path(), code);
  if (code) {
    throw Error(Error::Code::kIo, arguments->list + ": its folder cannot be entered (" +
                                      code.message() + "); check the path");
  }
  arguments->list = list.filename().string();
  arguments->folder = (start / arguments->folder).lexically_normal().string();
  if (!arguments->problem.empty()) {
    arguments->problem = fs::proximate(start / arguments->problem).string();
  }
}

std::string ProblemFileOf(const ListRun& run, int index) {
  const std::string& own = run.listed[static_cast<std::size_t>(index)].problem;
  return own.empty() ? run.arguments.problem : own;
}

Subject ReadListed(ListRun& run, const CommonArguments& common, int index) {
  return ReadSubject(common, run.listed[static_cast<std::size_t>(index)].path,
                     ProblemFileOf(run, index), run.arguments.reading,
                     [&run](const fs::path& file) { return run.problems.Read(file); });
}

/** Never throws because of what the files say: a path that cannot be read is an input too. */
verify::ListedInput InputOf(ListRun& run, int index) {
  CommonArguments silent = run.arguments.common;
  silent.quiet = true;
  verify::ListedInput input{run.listed[static_cast<std::size_t>(index)].path,
                            ProblemFileOf(run, index), "", ""};
  try {
    input.path_digest = numeric::io::Digest(numeric::io::ReadFileBytes(input.path, kMaxBytes));
    const Subject subject = ReadListed(run, silent, index);
    input.problem = subject.problem_file;
    input.model_digest = subject.problem.model_digest;
  } catch (const std::exception&) {
    // What is wrong with it is told when its own shard audits it.
  }
  return input;
}

bool IsMine(const ListRun& run, int index) {
  return index % run.manifest.shards == run.manifest.shard - 1;
}

bool HasBytes(const fs::path& file, const std::string& digest) {
  std::error_code code;
  return fs::is_regular_file(file, code) &&
         numeric::io::Digest(numeric::io::ReadFileBytes(file, kMaxBytes)) == digest;
}

verify::ShardManifest ReadBefore(const fs::path& file) {
  try {
    return verify::ReadManifest(file);
  } catch (const Error& e) {
    throw Error(e.code(), std::string(e.what()) + "; remove it to audit the shard anew");
  }
}

/** What an earlier run of this version finished on the same inputs with the same options, and whose
 files are still those it wrote. */
std::map<int, verify::ListedAudit> FinishedBefore(const ListRun& run, const fs::path& file) {
  std::map<int, verify::ListedAudit> finished;
  if (!run.arguments.resume || !fs::exists(file)) return finished;
  const verify::ShardManifest before = ReadBefore(file);
  if (before.tool_version != run.manifest.tool_version || before.options != run.manifest.options) {
    return finished;
  }
  for (const verify::ListedAudit& audit : before.audits) {
    const bool same = audit.index < run.manifest.listed && IsMine(run, audit.index) &&
                      audit.input == run.inputs[static_cast<std::size_t>(audit.index)];
    if (!same || !audit.finished || !audit.error.empty()) continue;
    const std::string& path = audit.input.path;
    if (HasBytes(run.folder / verify::ReportName(audit.index, path), audit.report_digest) &&
        HasBytes(run.folder / verify::CertificateName(audit.index, path),
                 audit.certificate_digest)) {
      finished[audit.index] = audit;
    }
  }
  return finished;
}

/** The proofs that an interrupted audit of the same path left; of anything else, none. */
std::vector<check::EdgeProof> ProofsBefore(const ListRun& run, const Subject& subject,
                                           const fs::path& file) {
  if (!run.arguments.resume || !fs::exists(file)) return {};
  try {
    check::Certificate known = ReadCertificate(file);
    const bool same_box = known.robust == ParseRobustness(run.arguments.robust);
    if (same_box && IsAbout(known, subject)) return std::move(known.proofs);
  } catch (const Error&) {
    // A damaged file of an earlier run is replaced.
  }
  return {};
}

/** Written as the audit goes on, so that whatever ends the run leaves a valid partial result. */
void WriteManifest(ListRun& run) {
  run.manifest.audits.clear();
  for (const auto& [index, audit] : run.audits) run.manifest.audits.push_back(audit);
  numeric::io::WriteFileAtomically(
      run.folder / verify::ManifestName(run.manifest.shard, run.manifest.shards),
      verify::WriteManifest(run.manifest));
}

/** The files of one path, and their digests. */
void WriteResults(const ListRun& run, const Subject& subject, const verify::WholeAudit& audit,
                  verify::ListedAudit* listed) {
  const Model& model = subject.problem.model;
  const auto write = [&run](const std::string& name, const std::string& text) {
    numeric::io::WriteFileAtomically(run.folder / name, text);
    return numeric::io::Digest(text);
  };
  std::vector<const check::EdgeProof*> proofs;
  for (const verify::EdgeFinding& edge : audit.edges) {
    if (edge.proof) proofs.push_back(&*edge.proof);
  }
  const std::string tool = std::string("cguide ") + kVersion;
  listed->certificate_digest =
      write(verify::CertificateName(listed->index, listed->input.path),
            verify::WriteCertificate(model, subject.path, tool, proofs, audit.robust));
  const verify::AuditSubject about{listed->input.path, subject.problem_file,
                                   subject.problem.model_digest, kVersion};
  listed->report_digest = write(verify::ReportName(listed->index, listed->input.path),
                                verify::WriteWholeJson(about, model, audit));
}

std::optional<Subject> ReadOrRecord(ListRun& run, verify::ListedAudit* listed) {
  try {
    Subject subject = ReadListed(run, run.arguments.common, listed->index);
    run.problems.ForgetWarnings(subject.problem_file);
    return subject;
  } catch (const Error& e) {
    const bool input = e.code() == Error::Code::kBadInput || e.code() == Error::Code::kIo;
    listed->verdict =
        input ? verify::ListedVerdict::kBadInput : verify::ListedVerdict::kInternalError;
    listed->error = e.what();
  } catch (const std::exception& e) {
    listed->verdict = verify::ListedVerdict::kInternalError;
    listed->error = e.what();
  }
  return std::nullopt;
}

std::optional<verify::WholeAudit> AuditOrRecord(ListRun& run, const Subject& subject,
                                                ProgressLine* progress,
                                                verify::ListedAudit* listed) {
  verify::WholeAuditOptions options;
  options.threads = ThreadCount(run.arguments.common);
  options.robust = ParseRobustness(run.arguments.robust);
  options.interrupt = &InterruptFlag();
  options.known = ProofsBefore(
      run, subject, run.folder / verify::CertificateName(listed->index, listed->input.path));
  options.on_progress = [&](int done, int edges) {
    progress->Show("auditing " + listed->input.path + ": edge " + std::to_string(done) + " of " +
                   std::to_string(edges));
  };
  try {
    const numeric::World world(subject.problem.model);
    return verify::AuditWhole(world, subject.path, options);
  } catch (const std::exception& e) {
    listed->verdict = verify::ListedVerdict::kInternalError;
    listed->error = e.what();
  }
  return std::nullopt;
}

verify::ListedAudit AuditListed(ListRun& run, int index, ProgressLine* progress) {
  verify::ListedAudit listed;
  listed.index = index;
  listed.input = run.inputs[static_cast<std::size_t>(index)];
  const std::optional<Subject> subject = ReadOrRecord(run, &listed);
  if (!subject) return listed;
  if (!(InputOf(run, index) == listed.input)) {
    throw Error(Error::Code::kBadInput,
                listed.input.path +
                    ": it has changed since the audit began; audit it again with "
                    "--resume");
  }
  const std::optional<verify::WholeAudit> audit = AuditOrRecord(run, *subject, progress, &listed);
  if (!audit) return listed;
  verify::TakeOver(*audit, &listed);
  WriteResults(run, *subject, *audit, &listed);
  return listed;
}

/** One text for one box of models, however it was written; empty where none was asked for. */
std::string BoxText(const std::string& robust) {
  using numeric::io::ShortestDouble;
  const check::Robustness box = ParseRobustness(robust);
  if (box == check::Robustness{}) return {};
  return "friction " + ShortestDouble(box.friction) + ", pose_m " + ShortestDouble(box.pose) +
         ", com_m " + ShortestDouble(box.com);
}

ListRun Prepare(const AuditArguments& given) {
  ListRun run;
  run.arguments = given;
  EnterFolderOfList(&run.arguments);
  run.folder = run.arguments.folder;
  run.listed = verify::ReadAuditList(run.arguments.list);
  const int count = static_cast<int>(run.listed.size());
  std::error_code code;
  fs::create_directories(run.folder, code);
  RequireWritable(run.folder / kSummaryName);
  verify::RefuseOtherDivisions(run.folder, given.shards);
  for (int i = 0; i < count; ++i) run.inputs.push_back(InputOf(run, i));
  run.manifest.tool_version = kVersion;
  run.manifest.shard = given.shard;
  run.manifest.shards = given.shards;
  run.manifest.listed = count;
  run.manifest.list_digest = verify::DigestOf(run.inputs);
  run.manifest.options = {{"path_format", run.arguments.reading.format},
                          {"joint_order", run.arguments.reading.joint_order},
                          {"root", run.arguments.reading.root},
                          {"robust", BoxText(run.arguments.robust)}};
  return run;
}

/** What this run can say: of one run over all, the summary; of a shard, its own paths. */
int Conclude(const ListRun& run) {
  if (run.manifest.shards == 1 && run.manifest.IsComplete()) {
    return WriteSummary(run.folder, 1, run.arguments.format);
  }
  if (run.arguments.format == "json") {
    std::cout << verify::WriteManifest(run.manifest);
  } else {
    std::cout << "shard " << run.manifest.shard << " of " << run.manifest.shards << ": "
              << verify::WriteSummaryText(run.manifest.audits);
  }
  const verify::ListedVerdict worst = verify::WorstOf(run.manifest.audits);
  return ExitCodeOf(
      run.manifest.IsComplete() ? worst : std::max(worst, verify::ListedVerdict::kInterrupted));
}

}  // namespace

int RunAuditList(const AuditArguments& given) {
  ListRun run = Prepare(given);
  const fs::path manifest =
      run.folder / verify::ManifestName(run.manifest.shard, run.manifest.shards);
  run.audits = FinishedBefore(run, manifest);
  // From here on the old summary is not about what lies in the folder.
  std::error_code code;
  fs::remove(run.folder / kSummaryName, code);
  WriteManifest(run);
  // At most once a second: the manifest of a long list is long. A run that is killed loses no more
  // than to audit that second's paths from their certificates.
  ProgressLine progress(run.arguments.common);
  auto written = std::chrono::steady_clock::now();
  for (int i = run.manifest.shard - 1; i < run.manifest.listed; i += run.manifest.shards) {
    if (InterruptFlag()) break;
    if (run.audits.contains(i)) continue;
    run.audits[i] = AuditListed(run, i, &progress);
    if (std::chrono::steady_clock::now() - written < std::chrono::seconds(1)) continue;
    WriteManifest(run);
    written = std::chrono::steady_clock::now();
  }
  WriteManifest(run);
  return Conclude(run);
}

}  // namespace cguide::cli
