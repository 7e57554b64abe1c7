// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/remedies.hpp"

#include <cctype>
#include <cmath>
#include <cstdlib>

namespace rpc
{
namespace
{

/// Reads sums of products of powers.
class Arithmetic
{
public:
  explicit Arithmetic(const std::string &text) : at_(text.c_str()) {}

  std::optional<double> value()
  {
    const double result = sum();
    skip_blanks();
    if (failed_ || *at_ != '\0' || operations_ == 0 || !std::isfinite(result)) return std::nullopt;
    return result;
  }

private:
  void skip_blanks()
  {
    while (std::isspace(static_cast<unsigned char>(*at_))) ++at_;
  }
  bool take(const char mark)
  {
    skip_blanks();
    if (*at_ != mark) return false;
    ++at_;
    return true;
  }

  double sum()
  {
    double result = product();
    for (;;) {
      if (take('+'))
        result += product();
      else if (take('-'))
        result -= product();
      else
        return result;
      ++operations_;
    }
  }
  double product()
  {
    double result = power();
    for (;;) {
      if (take('*'))
        result *= power();
      else if (take('/'))
        result /= power();
      else
        return result;
      ++operations_;
    }
  }
  double power()
  {
    if (take('-')) return -power();
    if (take('+')) return power();
    const double base = number();
    if (at_[0] == '*' && at_[1] == '*')
      at_ += 2;
    else if (!take('^'))
      return base;
    ++operations_;
    return std::pow(base, power());
  }
  double number()
  {
    if (++depth_ > deepest) failed_ = true;
    if (failed_) return 0;
    if (take('(')) {
      const double result = sum();
      failed_ |= !take(')');
      --depth_;
      return result;
    }
    skip_blanks();
    char *end = nullptr;
    const bool digit = std::isdigit(static_cast<unsigned char>(*at_)) || *at_ == '.'; // neither inf nor hexadecimals
    const double result = digit && at_[1] != 'x' ? std::strtod(at_, &end) : 0;
    failed_ |= end == nullptr || end == at_;
    if (!failed_) at_ = end;
    --depth_;
    return result;
  }

  static constexpr int deepest = 50;
  const char *at_;
  int operations_ = 0, depth_ = 0;
  bool failed_ = false;
};

} // namespace

std::optional<double> arithmetic(const std::string &text)
{
  constexpr std::size_t longest = 200; // signs nest, too
  if (text.size() > longest) return std::nullopt;
  return Arithmetic(text).value();
}

} // namespace rpc
