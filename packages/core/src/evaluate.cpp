// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/evaluate.hpp"

#include "rpc/core/error.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

namespace rpc
{
namespace
{

bool is_allowed(const double value, const bool allow_infinite)
{
  return allow_infinite ? !std::isnan(value) : std::isfinite(value);
}

Point point_at(const HostPoints &points, const std::size_t n)
{
  Point x{};
  for (std::size_t d = 0; d < points.extent(1); ++d) x[d] = points(n, d);
  return x;
}

std::string refusal(const ScalarField &field, const std::string &parameter, const double value,
                    const bool allow_infinite, const std::string &where)
{
  std::ostringstream message;
  message.precision(std::numeric_limits<double>::max_digits10);
  message << "deck: \"" << parameter << "\" = \"" << field.text << "\" must be a "
          << (allow_infinite ? "number or inf" : "finite number") << " everywhere, got "
          << (std::isnan(value) ? "nan"
              : value > 0       ? "inf"
                                : "-inf")
          << where;
  return message.str();
}

std::string place_text(const Point &x, const std::size_t dim)
{
  std::ostringstream text;
  text << " at (";
  for (std::size_t d = 0; d < dim; ++d) text << (d > 0 ? ", " : "") << x[d];
  text << ")";
  return text.str();
}

} // namespace

HostView<double *> evaluate(const ScalarField &field, const HostPoints &points, const std::string &parameter,
                            const Teuchos::Comm<int> &comm, const bool allow_infinite)
{
  HostView<double *> values(Kokkos::view_alloc("rpc::field_values", Kokkos::WithoutInitializing), points.extent(0));
  std::optional<std::string> message;
  if (field.is_constant()) {
    if (!is_allowed(field.constant, allow_infinite))
      message = refusal(field, parameter, field.constant, allow_infinite, "");
    Kokkos::deep_copy(values, field.constant);
  } else {
    for (std::size_t n = 0; n < points.extent(0); ++n) {
      const Point x = point_at(points, n);
      values(n) = field(x);
      if (!message && !is_allowed(values(n), allow_infinite))
        message = refusal(field, parameter, values(n), allow_infinite, place_text(x, points.extent(1)));
    }
  }
  throw_if_any(comm, ExitCode::bad_input, message);
  return values;
}

} // namespace rpc
