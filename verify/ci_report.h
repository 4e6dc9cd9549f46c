#pragma once

#include <string>

#include "cguide/verify/audit_checks.h"
#include "cguide/verify/audit_report.h"

namespace cguide::verify {

/** An audit as JUnit XML: one test suite, one test case an edge and obligation, in the form that
 Jenkins' junit-10.xsd and, for the suite, Maven Surefire's surefire-test-report.xsd describe.

 A refuted obligation is a <failure> with its witnesses. An undecided one is an <error>, as is one
 that an interrupted audit did not reach: readers show both in red and apart from failures, so that
 a suite is green exactly where the audit's exit code is 0. <skipped> is an obligation that is not
 asked because the edge collides already. All times are 0, so that the bytes are a function of path
 and model. */
std::string WriteJunit(const AuditSubject& subject, const AuditChecks& audit);

/** An audit as SARIF 2.1.0 [OASIS]: one result a witness, at the path file (a URI relative to the
 working folder, or file:// where the path is absolute) and the logical location "edge N". Rules:
 CG001 collision, CG002 joint limits, CG003 contact, CG004 balance, of level error; CG005, of level
 warning, where an obligation is undecided. An interrupted audit has executionSuccessful false and a
 notification. No times. */
std::string WriteSarif(const AuditSubject& subject, const AuditChecks& audit);

}  // namespace cguide::verify
