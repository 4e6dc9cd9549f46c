#include "cguide/numeric/stability.h"

#include "cguide/numeric/fp_guard.h"
#include "cguide/numeric/stability_contacts_internal.h"

namespace cguide::numeric {
namespace {

void ReportForce(const ScaledContacts& contacts, const Generator& generator, double weight,
                 ForceWitness* witness) {
  if (!(weight > 0)) return;
  witness->force[witness->size++] = {contacts.index[generator.contact], generator.u,
                                     weight * contacts.v_scale};
}

}  // namespace

void ReportBalance(const ScaledContacts& contacts, const Balance& balance, ForceWitness* witness) {
  witness->size = 0;
  for (int k = 0; k < 6; ++k) {
    ReportForce(contacts, balance.base[k], balance.weight[k], witness);
  }
  for (int k = 0; k < balance.num_extra; ++k) {
    ReportForce(contacts, balance.extra[k], balance.extra_weight[k], witness);
  }
}

StabilityWorkspace::StabilityWorkspace() : scratch(std::make_unique<Scratch>()) {}
StabilityWorkspace::~StabilityWorkspace() = default;
StabilityWorkspace::StabilityWorkspace(StabilityWorkspace&&) noexcept = default;
StabilityWorkspace& StabilityWorkspace::operator=(StabilityWorkspace&&) noexcept = default;

StabilityAnswer AskSimplex(const StabilityQuery& query, StabilityWorkspace* workspace,
                           Vector6d* deep) {
  StabilityAnswer answer;
  ScaledContacts& contacts = workspace->scratch->contacts;
  Balance& balance = workspace->scratch->balance;
  if (!ScaleContacts(query, &contacts)) return answer;
  SimplexEnd& end = workspace->scratch->end;
  end.count = -1;
  Vector6d y;
  Proposal proposal =
      SolveStability(contacts, contacts.num_certain, &balance, &y, &answer.pivots, &end, deep);
  if (proposal == Proposal::kNone && contacts.num_certain < contacts.count) {
    // The certain contacts do not carry the robot; do all that are possible leave it unstable?
    proposal = SolveStability(contacts, contacts.count, &balance, &y, &answer.pivots, &end, deep);
  }
  if (proposal == Proposal::kInterior) {
    answer.verdict = Verdict::kHolds;
    ReportBalance(contacts, balance, &answer.forces);
  } else if (proposal == Proposal::kOutside) {
    answer.verdict = Verdict::kFails;
    // g = y_f + y_m x r in units of the scaled arms: back to metres.
    y.tail<3>() /= contacts.length;
    answer.separator.y = y;
  }
  return answer;
}

StabilityAnswer TryStability(const StabilityQuery& query, StabilityWorkspace* workspace) {
  RequireRoundToNearest();
  return AskSimplex(query, workspace, nullptr);
}

}  // namespace cguide::numeric
