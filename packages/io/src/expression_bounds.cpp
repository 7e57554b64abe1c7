// SPDX-License-Identifier: BSD-3-Clause
#include "expression_bounds.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <map>
#include <utility>

namespace rpc::io
{

enum class ExpressionBounds::Operation {
  number,
  x,
  y,
  z,
  t,
  add,
  subtract,
  multiply,
  divide,
  power,
  negate,
  less,
  greater,
  less_or_equal,
  greater_or_equal,
  equal,
  different,
  logical_and,
  logical_or,
  choose, // first ? second : third
  sine,
  cosine,
  exponential,
  logarithm,
  square_root,
  absolute,
  hyperbolic_tangent,
  arc_tangent,
  minimum,
  maximum
};

namespace
{

constexpr double pi = 3.14159265358979323846, infinity = std::numeric_limits<double>::infinity();

/// An interval of numbers that may not be numbers: then nothing is known.
Interval between(const double a, const double b)
{
  return std::isnan(a) || std::isnan(b) ? Interval{} : Interval{std::min(a, b), std::max(a, b)};
}

Interval hull(const Interval &a, const Interval &b)
{
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

Interval product(const Interval &a, const Interval &b)
{
  const double corners[] = {a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high};
  Interval all{infinity, -infinity};
  for (const double c : corners) all = hull(all, between(c, c));
  return all;
}

Interval inverse(const Interval &a)
{
  if (a.low > 0 || a.high < 0) return {1 / a.high, 1 / a.low};
  return {};
}

/// An increasing function, with values from `least` on below its domain.
template <class Function>
Interval increasing(const Interval &a, const Function &f, const double domain = -infinity)
{
  return between(f(std::max(a.low, domain)), f(std::max(a.high, domain)));
}

/// x^n, n a whole number >= 0.
Interval whole_power(const Interval &a, const double n)
{
  const double low = std::pow(a.low, n), high = std::pow(a.high, n);
  if (std::fmod(n, 2) != 0) return between(low, high);
  return {a.contains(0) && n > 0 ? 0 : std::min(low, high), std::max(low, high)};
}

Interval power(const Interval &a, const Interval &b)
{
  const bool constant = b.low == b.high;
  if (constant && b.low == std::floor(b.low))
    return b.low >= 0 ? whole_power(a, b.low) : inverse(whole_power(a, -b.low));
  const double least = std::max(0., a.low), most = std::max(0., a.high); // else there is no value
  Interval all{infinity, -infinity};
  for (const double base : {least, most, std::clamp(1., least, most)})
    for (const double exponent : {b.low, b.high, std::clamp(0., b.low, b.high)}) {
      const double value = std::pow(base, exponent);
      all = hull(all, between(value, value));
    }
  return all;
}

/// cos over [a, b], with its extrema in between.
Interval cosine(const Interval &a)
{
  if (!(a.high - a.low < 2 * pi) || !std::isfinite(a.low)) return {-1, 1};
  Interval all = between(std::cos(a.low), std::cos(a.high));
  if (std::floor(a.high / (2 * pi)) != std::floor(a.low / (2 * pi))) all.high = 1;
  if (std::floor((a.high - pi) / (2 * pi)) != std::floor((a.low - pi) / (2 * pi))) all.low = -1;
  return all;
}

/// 1, 0 or both.
Interval truth(const bool always, const bool never)
{
  return {always ? 1. : 0., never ? 0. : 1.};
}
Interval is_less(const Interval &a, const Interval &b)
{
  return truth(a.high < b.low, a.low >= b.high);
}
Interval is_less_or_equal(const Interval &a, const Interval &b)
{
  return truth(a.high <= b.low, a.low > b.high);
}
Interval is_equal(const Interval &a, const Interval &b)
{
  return truth(a.low == a.high && b.low == b.high && a.low == b.low, a.high < b.low || a.low > b.high);
}
bool always(const Interval &a)
{
  return !a.contains(0);
}
bool never(const Interval &a)
{
  return a.low == 0 && a.high == 0;
}
Interval opposite(const Interval &a)
{
  return {1 - a.high, 1 - a.low};
}

} // namespace

/// Reads muParser's grammar: from the weakest operator to the strongest ?:, ||, &&, comparisons, + -, * /, the sign, ^.
class BoundsParser
{
public:
  explicit BoundsParser(const std::string &text) : text_(text) {}

  std::optional<ExpressionBounds> read()
  {
    expression();
    skip_blanks();
    if (!known_ || at_ != text_.size()) return std::nullopt;
    return std::move(bounds_);
  }

private:
  using Operation = ExpressionBounds::Operation;

  int step(const Operation operation, const int first = 0, const int second = 0, const int third = 0,
           const double number = 0)
  {
    bounds_.steps_.push_back({operation, number, first, second, third});
    return static_cast<int>(bounds_.steps_.size()) - 1;
  }
  int unknown()
  {
    known_ = false;
    return 0;
  }
  void skip_blanks()
  {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
  }
  bool take(const std::string &symbol)
  {
    skip_blanks();
    if (text_.compare(at_, symbol.size(), symbol) != 0) return false;
    at_ += symbol.size();
    return true;
  }

  int expression()
  {
    const int condition = disjunction();
    if (!known_ || !take("?")) return condition;
    const int yes = expression();
    if (!known_ || !take(":")) return unknown();
    const int no = expression();
    return step(Operation::choose, condition, yes, no);
  }
  int disjunction() { return from_the_left({{"||", Operation::logical_or}}, &BoundsParser::conjunction); }
  int conjunction() { return from_the_left({{"&&", Operation::logical_and}}, &BoundsParser::comparison); }
  int comparison() // the longer symbols first
  {
    return from_the_left({{"<=", Operation::less_or_equal},
                          {">=", Operation::greater_or_equal},
                          {"==", Operation::equal},
                          {"!=", Operation::different},
                          {"<", Operation::less},
                          {">", Operation::greater}},
                         &BoundsParser::sum);
  }
  int sum() { return from_the_left({{"+", Operation::add}, {"-", Operation::subtract}}, &BoundsParser::term); }
  int term() { return from_the_left({{"*", Operation::multiply}, {"/", Operation::divide}}, &BoundsParser::factor); }
  /// Operands of the next stronger kind, with any of some operators between them.
  int from_the_left(const std::vector<std::pair<const char *, Operation>> &operators, int (BoundsParser::*operand)())
  {
    int left = (this->*operand)();
    while (known_) {
      const auto found =
          std::find_if(operators.begin(), operators.end(), [&](const auto &each) { return take(each.first); });
      if (found == operators.end()) break;
      left = step(found->second, left, (this->*operand)());
    }
    return left;
  }
  int factor() // -x^2 is -(x^2)
  {
    if (take("-")) return step(Operation::negate, factor());
    if (take("+")) return factor();
    const int base = primary();
    if (!known_ || !take("^")) return base;
    return step(Operation::power, base, factor()); // from the right
  }
  int primary()
  {
    skip_blanks();
    if (take("(")) {
      const int inside = expression();
      return known_ && take(")") ? inside : unknown();
    }
    const char *const begin = text_.c_str() + at_;
    if (std::isdigit(static_cast<unsigned char>(*begin)) || *begin == '.') {
      char *end = nullptr;
      const double value = std::strtod(begin, &end);
      if (end == begin) return unknown();
      at_ += static_cast<std::size_t>(end - begin);
      return step(Operation::number, 0, 0, 0, value);
    }
    std::string name;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '_'))
      name += text_[at_++];
    return take("(") ? function(name) : symbol(name);
  }
  int symbol(const std::string &name)
  {
    static const std::map<std::string, Operation> variables{
        {"x", Operation::x}, {"y", Operation::y}, {"z", Operation::z}, {"t", Operation::t}};
    static const std::map<std::string, double> constants{
        {"pi", pi}, {"_pi", pi}, {"e", std::exp(1)}, {"_e", std::exp(1)}, {"inf", infinity}};
    if (const auto found = variables.find(name); found != variables.end()) return of_variable(found->second);
    if (const auto found = constants.find(name); found != constants.end())
      return step(Operation::number, 0, 0, 0, found->second);
    return unknown();
  }
  int of_variable(const Operation variable) // one step for all its places: x*x is a square
  {
    const auto found = variables_.find(variable);
    return found != variables_.end() ? found->second : variables_[variable] = step(variable);
  }
  int function(const std::string &name)
  {
    static const std::map<std::string, Operation> of_one{
        {"sin", Operation::sine},        {"cos", Operation::cosine},
        {"exp", Operation::exponential}, {"ln", Operation::logarithm},
        {"log", Operation::logarithm},   {"sqrt", Operation::square_root},
        {"abs", Operation::absolute},    {"tanh", Operation::hyperbolic_tangent},
        {"atan", Operation::arc_tangent}};
    static const std::map<std::string, Operation> of_several{
        {"min", Operation::minimum}, {"max", Operation::maximum}, {"sum", Operation::add}};
    std::vector<int> arguments;
    do arguments.push_back(expression());
    while (known_ && take(","));
    if (!known_ || !take(")")) return unknown();
    if (const auto found = of_one.find(name); found != of_one.end())
      return arguments.size() == 1 ? step(found->second, arguments[0]) : unknown();
    const auto found = of_several.find(name);
    if (found == of_several.end()) return unknown();
    int all = arguments[0];
    for (std::size_t k = 1; k < arguments.size(); ++k) all = step(found->second, all, arguments[k]);
    return all;
  }

  const std::string &text_;
  std::size_t at_ = 0;
  bool known_ = true;
  std::map<Operation, int> variables_;
  ExpressionBounds bounds_;
};

std::optional<ExpressionBounds> ExpressionBounds::of(const std::string &text)
{
  return BoundsParser(text).read();
}

Interval ExpressionBounds::operator()(const Box &box, const double t) const
{
  std::vector<Interval> value(steps_.size());
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    const Step &s = steps_[k];
    const Interval &a = value[s.first], &b = value[s.second], &c = value[s.third];
    const auto evaluated = [&]() -> Interval {
      switch (s.operation) {
      case Operation::number:
        return {s.number, s.number};
      case Operation::x:
        return {box.low[0], box.high[0]};
      case Operation::y:
        return {box.low[1], box.high[1]};
      case Operation::z:
        return {box.low[2], box.high[2]};
      case Operation::t:
        return {t, t};
      case Operation::add:
        return between(a.low + b.low, a.high + b.high);
      case Operation::subtract:
        return between(a.low - b.high, a.high - b.low);
      case Operation::multiply:
        return s.first == s.second ? whole_power(a, 2) : product(a, b);
      case Operation::divide:
        return product(a, inverse(b));
      case Operation::power:
        return power(a, b);
      case Operation::negate:
        return {-a.high, -a.low};
      case Operation::less:
        return is_less(a, b);
      case Operation::greater:
        return is_less(b, a);
      case Operation::less_or_equal:
        return is_less_or_equal(a, b);
      case Operation::greater_or_equal:
        return is_less_or_equal(b, a);
      case Operation::equal:
        return is_equal(a, b);
      case Operation::different:
        return opposite(is_equal(a, b));
      case Operation::logical_and:
        return truth(always(a) && always(b), never(a) || never(b));
      case Operation::logical_or:
        return truth(always(a) || always(b), never(a) && never(b));
      case Operation::choose:
        return always(a) ? b : never(a) ? c : hull(b, c);
      case Operation::sine:
        return cosine({a.low - pi / 2, a.high - pi / 2});
      case Operation::cosine:
        return cosine(a);
      case Operation::exponential:
        return increasing(a, [](const double x) { return std::exp(x); });
      case Operation::logarithm:
        return increasing(
            a, [](const double x) { return std::log(x); }, 0);
      case Operation::square_root:
        return increasing(
            a, [](const double x) { return std::sqrt(x); }, 0);
      case Operation::absolute:
        return {a.contains(0) ? 0 : std::min(std::abs(a.low), std::abs(a.high)),
                std::max(std::abs(a.low), std::abs(a.high))};
      case Operation::hyperbolic_tangent:
        return increasing(a, [](const double x) { return std::tanh(x); });
      case Operation::arc_tangent:
        return increasing(a, [](const double x) { return std::atan(x); });
      case Operation::minimum:
        return {std::min(a.low, b.low), std::min(a.high, b.high)};
      case Operation::maximum:
        return {std::max(a.low, b.low), std::max(a.high, b.high)};
      }
      return {};
    };
    value[k] = evaluated();
  }
  return value.back();
}

} // namespace rpc::io
