// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/io/rough_surface.hpp"

#include "rpc/core/byte_order.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/parameters.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <random>
#include <sstream>

namespace rpc::io
{
namespace
{

using Complex = std::complex<double>;
/// Of a circle, and of a surface that a file and the memory hold.
struct SurfaceBounds {
  static constexpr double two_pi = 6.28318530717958647692;
  static constexpr int points = 16384;
};

/// Numbers from 0 to below 1, the same on all machines.
class Uniform
{
public:
  explicit Uniform(const int seed) : engine_(static_cast<std::uint64_t>(seed)) {}
  double operator()() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

private:
  std::mt19937_64 engine_;
};

/// Amplitudes c_q of whole q = (p, r): both directions from -size to size.
struct Waves {
  int size;
  bool is_profile;
  std::vector<Complex> c;

  Waves(const int highest, const bool profile)
      : size(highest), is_profile(profile),
        c(static_cast<std::size_t>(2 * highest + 1) * (profile ? 1 : 2 * highest + 1))
  {
  }
  Complex &at(const int p, const int r)
  {
    return c[static_cast<std::size_t>(is_profile ? 0 : r + size) * (2 * size + 1) + p + size];
  }
  template <class Visit>
  void each(const Visit &visit)
  {
    const int rows = is_profile ? 0 : size;
    for (int r = -rows; r <= rows; ++r)
      for (int p = -size; p <= size; ++p) visit(p, r, at(p, r));
  }
};

/// Draws the waves of one half of the plane, ring by ring from the lowest, so that a wave's numbers do not depend on the highest; the
/// other half has their conjugates, so that heights are real.
void draw(Waves &waves, const RoughSurfaceOptions &o)
{
  Uniform uniform(o.seed);
  const double exponent = (o.is_profile ? 0.5 : 1) + o.hurst;
  const auto draw_one = [&](const int p, const int r) {
    const double phase = SurfaceBounds::two_pi * uniform(),
                 other = uniform(); // both of all waves, whatever is made of them
    const double q = std::hypot(p, r);
    if (q < o.lowest || q > o.highest) return;
    const double size = o.gaussian ? std::sqrt(-std::log(1 - other)) : 1;
    const Complex c = std::polar(size * std::pow(std::max(q, o.roll_off), -exponent), phase);
    waves.at(p, r) = c;
    waves.at(-p, -r) = std::conj(c);
  };
  for (int ring = 1; ring <= waves.size; ++ring) {
    if (o.is_profile) {
      draw_one(ring, 0);
      continue;
    }
    for (int r = 0; r <= ring; ++r)
      for (int p = -ring; p <= ring; ++p)
        if (std::max(std::abs(p), r) == ring && (r > 0 || p > 0)) draw_one(p, r);
  }
  if (!o.symmetric) return;
  Waves mirrored = waves;
  mirrored.each([&](const int p, const int r, Complex &c) {
    c = (waves.at(p, r) + waves.at(-p, r) + waves.at(p, -r) + waves.at(-p, -r)).real() / 4;
  });
  waves = mirrored;
}

/// Scales the waves to the root mean square that is asked for.
void scale(Waves &waves, const RoughSurfaceOptions &o)
{
  double heights = 0, slopes = 0;
  waves.each([&](const int p, const int r, const Complex &c) {
    const double q = SurfaceBounds::two_pi * std::hypot(p, r) / o.period;
    heights += std::norm(c);
    slopes += q * q * std::norm(c);
  });
  RPC_REQUIRE(heights > 0,
              "command line: --make-surface: \"Lowest Wave Number\" and \"Highest Wave Number\" must have a whole "
              "number of waves a period between them, got "
                  << o.lowest << " and " << o.highest);
  const double factor = o.rms_slope > 0 ? o.rms_slope / std::sqrt(slopes) : o.rms_height / std::sqrt(heights);
  for (Complex &c : waves.c) c *= factor;
}

void append(std::string &text, const void *const data, const std::size_t size)
{
  text.append(static_cast<const char *>(data), size);
}

} // namespace

Teuchos::ParameterList valid_rough_surface_parameters()
{
  Teuchos::ParameterList valid("Rough Surface");
  valid.set("Profile", false, "One row of heights, for bodies in the plane.");
  valid.set("Points", 64, "Heights along each direction, from 2 to 16384.");
  valid.set("Period", 1., "Length after which the surface repeats, > 0 [m]; neighbours are Period/Points apart.");
  valid.set("Hurst Exponent", 0.8, "From 0 to 1.");
  valid.set("Lowest Wave Number", 1., "Waves a period, >= 1: longer ones are left out.");
  valid.set("Roll-Off Wave Number", 0., "Waves a period: longer ones have its power; 0: the lowest one.");
  valid.set("Highest Wave Number", 0., "Waves a period, at most Points/2: shorter ones are left out; 0: Points/4.");
  valid.set("RMS Slope", 0., "Root mean square of the slope, > 0; 0: see RMS Height.");
  valid.set("RMS Height", 0., "Root mean square of the heights, > 0 [m]; 0: see RMS Slope.");
  set_words(valid, "Amplitudes", {"constant", "gaussian"},
            "`constant`: all randomness is in the phases; `gaussian`: amplitudes are random, too.");
  valid.set("Symmetric", false,
            "Mirrored about 0 and Period/2 along x and y, as a body between planes of symmetry needs it.");
  valid.set("Seed", 1, "Another one gives another surface, >= 0.");
  return valid;
}

RoughSurfaceOptions rough_surface_options(const Teuchos::ParameterList &list)
{
  RoughSurfaceOptions o;
  const std::string where = "command line: --make-surface: ";
  const auto number = [&](const std::string &name, const double least, const double most, const bool may_be_least,
                          const std::string &rule) {
    const double value = list.get<double>(name);
    RPC_REQUIRE(value <= most && (value > least || (may_be_least && value == least)),
                where << "\"" << name << "\" must be " << rule << ", got " << value);
    return value;
  };
  constexpr double much = 1e30;
  o.is_profile = list.get<bool>("Profile");
  o.points = list.get<int>("Points");
  RPC_REQUIRE(o.points >= 2 && o.points <= SurfaceBounds::points,
              where << "\"Points\" must be from 2 to " << SurfaceBounds::points << ", got " << o.points);
  o.period = number("Period", 0, much, false, "> 0 and finite [m]");
  o.hurst = number("Hurst Exponent", 0, 1, true, "from 0 to 1");
  o.lowest = number("Lowest Wave Number", 1, much, true, ">= 1 and finite");
  const double roll_off = number("Roll-Off Wave Number", 0, much, true, ">= 0 and finite");
  o.roll_off = roll_off > 0 ? roll_off : o.lowest;
  std::ostringstream rule;
  rule << "from \"Lowest Wave Number\" = " << o.lowest << " to \"Points\"/2 = " << o.points / 2.
       << ", or 0 for \"Points\"/4";
  const double highest = number("Highest Wave Number", 0, o.points / 2., true, rule.str());
  o.highest = highest > 0 ? highest : o.points / 4.;
  RPC_REQUIRE(o.highest >= o.lowest,
              where << "\"Highest Wave Number\" must be " << rule.str() << ", got " << o.highest);
  o.rms_slope = number("RMS Slope", 0, much, true, ">= 0 and finite");
  o.rms_height = number("RMS Height", 0, much, true, ">= 0 and finite [m]");
  RPC_REQUIRE((o.rms_slope > 0) != (o.rms_height > 0),
              where << "one of \"RMS Slope\" and \"RMS Height\" must be > 0, got " << o.rms_slope << " and "
                    << o.rms_height << ". Add --set=\"RMS Slope=0.1\"");
  o.gaussian = list.get<std::string>("Amplitudes") == "gaussian";
  o.symmetric = list.get<bool>("Symmetric");
  o.seed = list.get<int>("Seed");
  RPC_REQUIRE(o.seed >= 0, where << "\"Seed\" must be >= 0, got " << o.seed);
  return o;
}

std::vector<double> rough_surface(const RoughSurfaceOptions &o)
{
  Waves waves(static_cast<int>(std::floor(o.highest)), o.is_profile);
  draw(waves, o);
  scale(waves, o);
  const int n = o.points, m = waves.size;
  std::vector<Complex> turn(n); // exp(2 pi i k/n)
  for (int k = 0; k < n; ++k) turn[k] = std::polar(1., SurfaceBounds::two_pi * k / n);
  const auto index = [n](const long long k) { return static_cast<std::size_t>((k % n + n) % n); };
  const int rows = o.is_profile ? 1 : n, half = o.is_profile ? 0 : m;
  std::vector<double> heights;
  heights.reserve(static_cast<std::size_t>(rows) * n);
  std::vector<Complex> along_y(m + 1); // of waves with p >= 0, at a row: those with p < 0 are their conjugates
  for (int j = 0; j < rows; ++j) {
    for (int p = 0; p <= m; ++p) {
      Complex sum = 0;
      for (int r = -half; r <= half; ++r) sum += waves.at(p, r) * turn[index(static_cast<long long>(r) * j)];
      along_y[p] = p == 0 ? sum : 2. * sum;
    }
    for (int i = 0; i < n; ++i) {
      double sum = 0;
      for (int p = 0; p <= m; ++p) {
        const Complex &e = turn[index(static_cast<long long>(p) * i)];
        sum += along_y[p].real() * e.real() - along_y[p].imag() * e.imag();
      }
      heights.push_back(sum);
    }
  }
  return heights;
}

std::string heights_as(const std::string &ending, const std::vector<double> &heights, const int columns,
                       const double spacing)
{
  const std::size_t rows = heights.size() / columns;
  if (ending == ".npy") {
    std::ostringstream header;
    header << "{'descr': '" << (is_little_endian() ? '<' : '>') << "f8', 'fortran_order': False, 'shape': (";
    if (rows > 1) header << rows << ", ";
    header << columns << (rows > 1 ? ")" : ",)") << ", }";
    std::string text = header.str();
    text.append(63 - (10 + text.size()) % 64, ' '); // numbers begin at a multiple of 64
    text += '\n';
    std::string bytes("\x93NUMPY\x01\x00", 8);
    bytes += static_cast<char>(text.size() % 256);
    bytes += static_cast<char>(text.size() / 256);
    bytes += text;
    append(bytes, heights.data(), heights.size() * sizeof(double));
    return bytes;
  }
  RPC_REQUIRE(ending == ".csv" || ending == ".asc", "command line: --make-surface writes .npy, .csv and .asc, got \""
                                                        << ending << "\". Name the file heights.npy");
  const bool grid = ending == ".asc";
  std::ostringstream out;
  out.precision(17);
  if (grid)
    out << "ncols " << columns << "\nnrows " << rows << "\nxllcorner 0\nyllcorner 0\ncellsize " << spacing << '\n';
  for (std::size_t j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      out << heights[(grid ? rows - 1 - j : j) * columns + i] << (i + 1 == columns ? '\n' : grid ? ' ' : ',');
  return out.str();
}

} // namespace rpc::io
