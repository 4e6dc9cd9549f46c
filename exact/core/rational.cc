// SPDX-License-Identifier: Apache-2.0
#include "cguide/exact/core/rational.h"

#include <mpfr.h>

#include <cctype>
#include <cmath>

#include "cguide/exact/core/error.h"

namespace cguide {
namespace {

double RoundTo(const Rational& x, mpfr_rnd_t direction) {
  mpfr_t wide;
  mpfr_init2(wide, 53);
  // Rounding once to 53 bits and then to a subnormal would round twice, so the value is made
  // subnormal in MPFR's own way when its exponent asks for it.
  const mpfr_exp_t emin = mpfr_get_emin();
  const mpfr_exp_t emax = mpfr_get_emax();
  mpfr_set_emin(-1073);
  mpfr_set_emax(1024);
  const int ternary = mpfr_set_q(wide, x.get_mpq_t(), direction);
  mpfr_subnormalize(wide, ternary, direction);
  const double result = mpfr_get_d(wide, direction);
  mpfr_set_emin(emin);
  mpfr_set_emax(emax);
  mpfr_clear(wide);
  return result;
}

[[noreturn]] void Refuse(std::string_view text) {
  throw Error(Error::Code::kBadInput,
              "\"" + std::string(text.substr(0, 80)) +
                  "\" is not a rational number; write 3, -0.25, 1e-3 or 1/7");
}

// Reads digits [. digits] [e exponent] without sign.
Rational ParseDecimal(std::string_view text, std::string_view whole) {
  std::string digits;
  long scale = 0;
  std::size_t i = 0;
  bool after_point = false;
  for (; i < text.size() && (std::isdigit(static_cast<unsigned char>(text[i])) || text[i] == '.');
       ++i) {
    if (text[i] == '.') {
      if (after_point) Refuse(whole);
      after_point = true;
    } else {
      digits += text[i];
      if (after_point) --scale;
    }
  }
  if (digits.empty()) Refuse(whole);
  if (i < text.size()) {
    if (text[i] != 'e' && text[i] != 'E') Refuse(whole);
    const std::string exponent(text.substr(i + 1));
    std::size_t used = 0;
    long value = 0;
    try {
      value = std::stol(exponent, &used);
    } catch (const std::exception&) {
      Refuse(whole);
    }
    if (used != exponent.size() || std::labs(value) > 10000) Refuse(whole);
    scale += value;
  }
  mpz_class power;
  mpz_ui_pow_ui(power.get_mpz_t(), 10, static_cast<unsigned long>(std::labs(scale)));
  Rational result =
      scale >= 0 ? Rational(mpz_class(digits, 10) * power) : Rational(mpz_class(digits, 10), power);
  result.canonicalize();
  return result;
}

}  // namespace

Rational Lift(double x) {
  Require(std::isfinite(x), "a NaN or an infinity has no exact value");
  return Rational(x);
}

Vector3q Lift(const Eigen::Vector3d& x) { return {Lift(x[0]), Lift(x[1]), Lift(x[2])}; }

Sign SignOf(const Rational& x) { return static_cast<Sign>(sgn(x)); }

std::string ToText(const Rational& x) { return x.get_str(); }

Rational ParseRational(std::string_view text) {
  const std::string_view whole = text;
  const bool negative = !text.empty() && text.front() == '-';
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) text.remove_prefix(1);
  const std::size_t slash = text.find('/');
  Rational result = ParseDecimal(text.substr(0, slash), whole);
  if (slash != std::string_view::npos) {
    const Rational denominator = ParseDecimal(text.substr(slash + 1), whole);
    if (denominator == 0) Refuse(whole);
    result /= denominator;
  }
  return negative ? Rational(-result) : result;
}

double NearestDouble(const Rational& x) { return RoundTo(x, MPFR_RNDN); }
double RoundDown(const Rational& x) { return RoundTo(x, MPFR_RNDD); }
double RoundUp(const Rational& x) { return RoundTo(x, MPFR_RNDU); }

}  // namespace cguide
