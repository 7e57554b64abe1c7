#include "rpc/contact/smoothed_functional.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rpc::contact
{

// Kernels are free functions: nvcc takes no device lambda in a constructor or a private member.
namespace
{

// Multiples of a node's own stiffness. What a penalty r = gamma k leaves of v after one minimization is 1/gamma of what
// the pressure would press the node alone; what it makes of the rounding of v is gamma eps of the same.
constexpr double default_penalty = 1e5, largest_penalty = 1e8, penalty_raise = 100;
// Where the direction lies along no axis, the penalty is on the diagonal of unknowns along the surface too, and smoothers
// that go by the diagonal do too little there: 160 CG iterations instead of 30 on the half cylinder's own normals.
constexpr double default_slanting_penalty = 1e3;
// In units of E/diameter: weak enough not to slow Newton down once nodes stick, strong against the rounding of K.
constexpr double weak_spring = 1e-4, weakest_spring = 1e-10, weaken = 1e-2;
// Multiple of the mean pressure, load over contact area, above which a yield limit counts as out of reach at the start.
constexpr double beyond_reach = 100;
// Weight of penetration against pressure in the first choice of states, in E / diameter: where a coarser mesh predicts u and
// lambda, either may be the better known one.
constexpr double first_weight = 10;

KOKKOS_INLINE_FUNCTION double larger(const double a, const double b)
{
  return a > b || a != a ? a : b; // keeps a NaN
}
KOKKOS_INLINE_FUNCTION double magnitude(const double x)
{
  return x < 0 ? -x : x;
}

/// The paper's start l = 0, which is half the yield limit, where the body touches. Where there is a gap, or where the yield
/// limit is out of reach of the load, no pressure is the better guess.
/// @param reach  [Pa]
void start_multipliers(const ContactNodes &c, const double reach, const DeviceView<double *> &lambda)
{
  Kokkos::parallel_for(
      "rpc::contact::start", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        const bool apart = c.stiffness(i) * c.free_gap(i) > 1e-9 * c.yield(i); // more than rounding
        lambda(i) = c.fixed(i) || apart || c.yield(i) > reach ? 0 : 0.5 * c.yield(i);
      });
}

/// This rank's sum of the weights of nodes that take part in the solution.
double free_weight(const ContactNodes &c)
{
  double sum = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::free_weight", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &part) { part += c.fixed(i) ? 0 : c.weight(i); }, sum);
  return sum;
}

/// Whether a direction lies along an axis, up to rounding.
KOKKOS_INLINE_FUNCTION bool along_an_axis(const ContactNodes &c, const LO i)
{
  double length = 0, largest = 0;
  for (int k = 0; k < c.dim; ++k) {
    const double square = c.direction(i, k) * c.direction(i, k);
    length += square;
    largest = larger(largest, square);
  }
  return length - largest <= 1e-12 * length;
}

/// A copy whose penalties are chosen where they are left open, and bounded. (5.8)
ContactNodes with_penalties(ContactNodes c, const DeviceView<double *> &own)
{
  const auto given = c.penalty;
  DeviceView<double *> penalty("rpc::contact::penalty", c.size());
  Kokkos::parallel_for(
      "rpc::contact::choose_penalty", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        penalty(i) = given(i) > 0          ? given(i)
                     : along_an_axis(c, i) ? default_penalty * own(i)
                                           : default_slanting_penalty * own(i);
        if (own(i) > 0 && penalty(i) > largest_penalty * own(i)) penalty(i) = largest_penalty * own(i);
      });
  c.penalty = penalty;
  return c;
}

/// (contact nodes) What the states add to K: r where a node sticks, else the weak spring [Pa/m].
DeviceView<double *> added_stiffness(const ContactNodes &c, const DeviceView<State *> &piece, const double spring)
{
  DeviceView<double *> added("rpc::contact::added", c.size());
  Kokkos::parallel_for(
      "rpc::contact::stiffen", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        if (!c.fixed(i)) added(i) = piece(i) == State::stuck ? c.penalty(i) : spring * c.stiffness(i);
      });
  Kokkos::fence();
  return added;
}

/// This rank's sum_i w_i Psi_i(v_i) (smoothed) or sum_i w_i lambda_i v_i.
double energy_at_nodes(const ContactNodes &c, const DeviceView<double *> &lambda, const Vector &u, const bool smoothed)
{
  const auto x = device_read(u);
  double sum = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::energy", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &part) {
        const double v = penetration(c, i, x);
        const double xi = c.yield(i);
        if (c.fixed(i))
          part += c.weight(i) * plastic_energy(v, xi);
        else
          part += c.weight(i) * (smoothed ? smoothed_energy(v, lambda(i), c.penalty(i), xi) : lambda(i) * v);
      },
      sum);
  return sum;
}

/// F += sum_i w_i p_i m_i.
void add_contact_force(const ContactNodes &c, const DeviceView<double *> &p, Vector &F)
{
  const auto to = device_write(F);
  for_each_point_by_side(
      "rpc::contact::force", c, KOKKOS_LAMBDA(const LO i) {
        for (int k = 0; k < c.dim; ++k) to(c.dim * c.node(i) + k) += c.weight(i) * p(i) * c.direction(i, k);
      });
  Kokkos::fence();
}

/// (contact nodes) Psi_i'(v_i).
DeviceView<double *> pressures(const ContactNodes &c, const DeviceView<double *> &lambda, const Vector &u)
{
  DeviceView<double *> p("rpc::contact::pressure", c.size());
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::pressure", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i) { p(i) = pressure(penetration(c, i, x), lambda(i), c.penalty(i), c.yield(i)); });
  return p;
}

/// (contact nodes) The pressures of the piece of given states, whether they lie in [0, xi] or not.
DeviceView<double *> piece_pressures(const ContactNodes &c, const DeviceView<double *> &lambda, const Vector &u,
                                     const DeviceView<State *> &piece)
{
  DeviceView<double *> p("rpc::contact::piece_pressure", c.size());
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::piece_pressure", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        if (piece(i) == State::stuck)
          p(i) = lambda(i) + c.penalty(i) * penetration(c, i, x);
        else
          p(i) = piece(i) == State::yielded ? c.yield(i) : 0;
      });
  return p;
}

/// The first states: those of lambda + weight rho v, or all stuck.
void first_states(const ContactNodes &c, const Vector &u, const DeviceView<double *> &lambda, const bool all_stick,
                  const DeviceView<State *> &next)
{
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::first_states", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        const double rho = first_weight * c.stiffness(i);
        next(i) = c.fixed(i)  ? State::open
                  : all_stick ? State::stuck
                              : state(penetration(c, i, x), lambda(i), rho, c.yield(i));
      });
  Kokkos::fence();
}

/// This rank's largest pressure, as far as the law allows it [Pa].
double largest_pressure(const ContactNodes &c, const DeviceView<double *> &p)
{
  double largest = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::largest_pressure", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &most) { most = larger(most, clamp(p(i), 0, c.yield(i))); },
      Kokkos::Max<double>(largest));
  return std::max(0., largest);
}

/// A point that violates the contact law by more than a pressure goes from stuck to open or yielded, else to stuck. For a
/// penetration stands k v, with k the stiffness of the node alone.
void next_states(const ContactNodes &c, const Vector &u, const DeviceView<State *> &piece,
                 const DeviceView<double *> &p, const DeviceView<double *> &own, const double bound,
                 const DeviceView<State *> &next)
{
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::next_states", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        next(i) = piece(i);
        if (c.fixed(i)) return;
        const double kv = own(i) * penetration(c, i, x);
        if (piece(i) == State::stuck)
          next(i) = p(i) < -bound ? State::open : p(i) > c.yield(i) + bound ? State::yielded : State::stuck;
        else if ((piece(i) == State::open ? kv : -kv) > bound)
          next(i) = State::stuck;
      });
  Kokkos::fence();
}

LO count_differences(const DeviceView<State *> &a, const DeviceView<State *> &b)
{
  LO count = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::count_differences", device_range(static_cast<LO>(a.extent(0))),
      KOKKOS_LAMBDA(const LO i, LO &part) { part += a(i) != b(i); }, count);
  return count;
}

/// The moves of a sweep, from the elastic gradient at u; those of two points of one node add up.
void move_points(const ContactNodes &c, const DeviceView<double *> &lambda, const DeviceView<double *> &stiffness,
                 const Vector &G, Vector &u)
{
  const DeviceView<double *> move("rpc::contact::move", c.size());
  {
    const auto slope = device_read(G);
    const auto x = device_read(u);
    Kokkos::parallel_for(
        "rpc::contact::best_moves", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
          if (c.fixed(i)) return;
          double length = 0;
          for (int k = 0; k < c.dim; ++k) length += c.direction(i, k) * c.direction(i, k);
          move(i) = best_move(along_direction(c, i, slope) / length, stiffness(i), c.weight(i), penetration(c, i, x),
                              lambda(i), c.penalty(i), c.yield(i)) /
                    length;
        });
    Kokkos::fence();
  }
  const auto x = device_write(u);
  for_each_point_by_side(
      "rpc::contact::move_points", c, KOKKOS_LAMBDA(const LO i) {
        for (int k = 0; k < c.dim; ++k) x(c.dim * c.node(i) + k) += move(i) * c.direction(i, k);
      });
  Kokkos::fence();
}

/// lambda <- p, brought into [0, xi]. @return |change|_2 / |lambda|_2 over all ranks, 0 if nothing changed; collective
double replace_multipliers(const Comm &comm, const ContactNodes &c, const DeviceView<double *> &p,
                           const DeviceView<double *> &lambda)
{
  double sums[2] = {0, 0};
  Kokkos::parallel_reduce(
      "rpc::contact::replace_multipliers", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &change, double &size) {
        if (c.fixed(i)) return;
        const double next = clamp(p(i), 0, c.yield(i));
        change += (next - lambda(i)) * (next - lambda(i));
        size += next * next;
        lambda(i) = next;
      },
      sums[0], sums[1]);
  double all[2];
  Teuchos::reduceAll(comm, Teuchos::REDUCE_SUM, 2, sums, all);
  if (all[0] == 0) return 0;
  return std::sqrt(all[0] / std::max(all[1], all[0])); // all multipliers gone to zero is a change of 1, not of infinity
}

/// (contact nodes) -v_i(u): what is left of the gaps once u is the origin.
DeviceView<double *> left_of_gap(const ContactNodes &c, const Vector &u)
{
  DeviceView<double *> gap("rpc::contact::gap_left", c.size());
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::gap_left", device_range(c.size()), KOKKOS_LAMBDA(const LO i) { gap(i) = -penetration(c, i, x); });
  return gap;
}

/// A number in which all bits of the argument take part.
KOKKOS_INLINE_FUNCTION std::uint64_t scrambled(std::uint64_t x)
{
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// Sum over all ranks of a number for each node and its state.
std::uint64_t fingerprint_of(const Comm &comm, const ContactNodes &c, const DeviceView<State *> &state)
{
  const std::uint64_t rank = comm.getRank();
  std::uint64_t sum = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::fingerprint", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, std::uint64_t &part) {
        part += scrambled((rank << 40) + 4 * static_cast<std::uint64_t>(i) + static_cast<std::uint64_t>(state(i)) + 1);
      },
      sum);
  // As halves, for sums of 64 bits would overflow a signed GO.
  const GO halves[2] = {static_cast<GO>(sum & 0xffffffffULL), static_cast<GO>(sum >> 32)};
  GO all[2];
  Teuchos::reduceAll(comm, Teuchos::REDUCE_SUM, 2, halves, all);
  return static_cast<std::uint64_t>(all[0]) + (static_cast<std::uint64_t>(all[1]) << 32);
}

} // namespace

LineModel::LineModel(RCP<const Comm> comm, const double slope_at_0, const double elastic_curvature,
                     const ContactNodes &contact, DeviceView<double *> v, DeviceView<double *> dv,
                     DeviceView<double *> lambda)
    : comm_(std::move(comm)), slope_at_0_(slope_at_0), elastic_curvature_(elastic_curvature), contact_(contact),
      v_(std::move(v)), dv_(std::move(dv)), lambda_(std::move(lambda))
{
}

LineModel::Value LineModel::at(const double t) const
{
  const ContactNodes c = contact_;
  const auto v = v_;
  const auto dv = dv_;
  const auto lambda = lambda_;
  double sums[2] = {0, 0};
  Kokkos::parallel_reduce(
      "rpc::contact::line_model", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &slope, double &curvature) {
        const double r = c.penalty(i), xi = c.yield(i), moved = v(i) + t * dv(i);
        slope += c.weight(i) * dv(i) * (pressure(moved, lambda(i), r, xi) - pressure(v(i), lambda(i), r, xi));
        if (state(moved, lambda(i), r, xi) == State::stuck) curvature += c.weight(i) * r * dv(i) * dv(i);
      },
      sums[0], sums[1]);
  double all[2];
  Teuchos::reduceAll(*comm_, Teuchos::REDUCE_SUM, 2, sums, all);
  return {slope_at_0_ + elastic_curvature_ * t + all[0], elastic_curvature_ + all[1]};
}

SmoothedFunctional::SmoothedFunctional(RCP<const Comm> comm, fem::ElasticProblem problem, ContactNodes contact)
    : comm_(std::move(comm)), problem_(std::move(problem)), contact_(std::move(contact)),
      lambda_("rpc::contact::multiplier", contact_.size()), piece_("rpc::contact::piece", contact_.size()),
      hessian_(rcp(new ContactStiffness(problem_.stiffness, contact_)))
{
  Vector applied(*problem_.applied_load, Teuchos::Copy), lifted(*problem_.load, Teuchos::Copy);
  fem::clear_prescribed(problem_.dirichlet, applied);
  fem::clear_prescribed(problem_.dirichlet, lifted);
  applied_force_ = applied.norm2();
  lifted_force_ = lifted.norm2();
  const double weight = sum_all(*comm_, free_weight(contact_));
  reach_ = weight > 0 ? beyond_reach * lifted.norm1() / weight : 0;
  reset_multipliers();
  contact_ = with_penalties(contact_, hessian_->own_stiffness());
  near_ = contact_;
  load_ = problem_.load;
}

void SmoothedFunctional::hold_by_contact()
{
  spring_ = weak_spring;
}

void SmoothedFunctional::weaken_springs()
{
  if (spring_ > 0) spring_ = std::max(weaken * spring_, weakest_spring);
}

bool SmoothedFunctional::raise_penalty()
{
  const ContactNodes c = contact_;
  const auto own = hessian_->own_stiffness();
  LO raised = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::raise_penalty", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, LO &count) {
        double next = larger(penalty_raise * c.penalty(i), default_penalty * own(i));
        if (next > largest_penalty * own(i)) next = largest_penalty * own(i);
        if (!(next > c.penalty(i))) return;
        c.penalty(i) = next;
        ++count;
      },
      raised);
  update_stiffness();
  return sum_all(*comm_, GO(raised)) > 0;
}

GO SmoothedFunctional::update_stiffness()
{
  return hessian_->set(added_stiffness(contact_, piece_, spring_));
}

void SmoothedFunctional::set_multipliers(const DeviceView<double *> &lambda)
{
  predicted_ = true;
  const ContactNodes c = contact_;
  const auto to = lambda_;
  Kokkos::parallel_for(
      "rpc::contact::set_multipliers", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i) { to(i) = c.fixed(i) ? 0 : clamp(lambda(i), 0, c.yield(i)); });
  Kokkos::fence();
}

void SmoothedFunctional::reset_multipliers()
{
  if (lifted_force_ > 0)
    start_multipliers(contact_, reach_, lambda_); // else nothing acts, and lambda = 0 is the solution
  predicted_ = false;
}

void SmoothedFunctional::move_origin(Vector &u)
{
  const auto moved = rcp(new Vector(*load_, Teuchos::Copy));
  Vector Ku(u.getMap());
  hessian_->apply_elastic(u, Ku);
  moved->update(-1., Ku, 1.);
  load_ = moved;
  near_.free_gap = left_of_gap(near_, u);
  if (origin_.is_null())
    origin_ = rcp(new Vector(u, Teuchos::Copy));
  else
    origin_->update(1., u, 1.);
  u.putScalar(0);
}

Vector SmoothedFunctional::displacement(const Vector &u) const
{
  Vector sum(u, Teuchos::Copy);
  if (!origin_.is_null()) sum.update(1., *origin_, 1.);
  return sum;
}

double SmoothedFunctional::value(const Vector &u) const
{
  Vector Ku(u.getMap());
  hessian_->apply_elastic(u, Ku);
  return 0.5 * u.dot(Ku) - load_->dot(u) + problem_.energy_offset +
         sum_all(*comm_, energy_at_nodes(near_, lambda_, u, true));
}

double SmoothedFunctional::energy(const Vector &u) const
{
  Vector Ku(u.getMap());
  hessian_->apply_elastic(u, Ku);
  return 0.5 * u.dot(Ku) - problem_.load->dot(u) + problem_.energy_offset +
         sum_all(*comm_, energy_at_nodes(contact_, lambda_, u, false));
}

void SmoothedFunctional::gradient(const Vector &u, Vector &F) const
{
  elastic_gradient(u, F);
  add_contact_force(near_, pressures(near_, lambda_, u), F);
}

void SmoothedFunctional::elastic_gradient(const Vector &u, Vector &G) const
{
  hessian_->apply_elastic(u, G);
  G.update(-1., *load_, 1.);
}

void SmoothedFunctional::piece_gradient(const Vector &u, const Vector &G, Vector &F) const
{
  F.update(1., G, 0.);
  add_contact_force(near_, piece_pressures(near_, lambda_, u, piece_), F);
}

void SmoothedFunctional::sweep(Vector &u) const
{
  Vector G(u.getMap());
  elastic_gradient(u, G);
  move_points(near_, lambda_, hessian_->sweep_stiffness(), G, u);
}

GO SmoothedFunctional::update_hessian(const Vector &u)
{
  const ContactNodes c = near_;
  const auto lambda = lambda_;
  const auto piece = piece_;
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::update_hessian", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        if (!c.fixed(i)) piece(i) = state(penetration(c, i, x), lambda(i), c.penalty(i), c.yield(i));
      });
  piece_chosen_ = true;
  return update_stiffness();
}

StateChoice SmoothedFunctional::choose_states(const Vector &u, const double negligible) const
{
  const ContactNodes c = near_;
  const DeviceView<State *> next("rpc::contact::next_state", c.size());
  StateChoice choice{next, lambda_};
  if (piece_chosen_) {
    choice.pressure = piece_pressures(c, lambda_, u, piece_);
    const double bound = negligible * max_all(*comm_, largest_pressure(c, choice.pressure));
    next_states(c, u, piece_, choice.pressure, hessian_->own_stiffness(), bound, next);
  } else {
    first_states(c, u, lambda_, spring_ > 0 && !predicted_, next);
  }
  choice.changes = sum_all(*comm_, GO(count_differences(next, piece_)));
  choice.confirmed = choice.changes == 0 && piece_chosen_;
  choice.fingerprint = fingerprint_of(*comm_, c, next);
  return choice;
}

void SmoothedFunctional::take_states(const StateChoice &choice, Vector &u)
{
  const ContactNodes c = near_;
  const auto lambda = lambda_;
  const auto piece = piece_;
  const auto next = choice.state;
  const auto p = choice.pressure;
  piece_chosen_ = true;
  const auto x = device_write(u);
  for_each_point_by_side( // a node of two sides is moved for one after the other
      "rpc::contact::take_states", c, KOKKOS_LAMBDA(const LO i) {
        if (c.fixed(i)) return;
        if (next(i) == State::stuck && piece(i) != State::stuck) {
          double length = 0;
          for (int k = 0; k < c.dim; ++k) length += c.direction(i, k) * c.direction(i, k);
          const double move = penetration(c, i, x) / length;
          for (int k = 0; k < c.dim; ++k) x(c.dim * c.node(i) + k) -= move * c.direction(i, k);
        }
        piece(i) = next(i);
        if (next(i) == State::stuck)
          lambda(i) = clamp(p(i), 0, c.yield(i));
        else
          lambda(i) = next(i) == State::yielded ? c.yield(i) : 0;
      });
  Kokkos::fence();
  update_stiffness();
}

LineModel SmoothedFunctional::along(const Vector &u, const Vector &d, const Vector &F) const
{
  Vector Kd(d.getMap());
  hessian_->apply_elastic(d, Kd);
  const ContactNodes c = near_;
  DeviceView<double *> v("rpc::contact::v", c.size()), dv("rpc::contact::dv", c.size());
  const auto from = device_read(u);
  const auto step = device_read(d);
  Kokkos::parallel_for(
      "rpc::contact::along", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        v(i) = penetration(c, i, from);
        dv(i) = along_direction(c, i, step);
      });
  Kokkos::fence();
  return LineModel(comm_, d.dot(F), d.dot(Kd), near_, v, dv, lambda_);
}

StateCounts SmoothedFunctional::count_states(const Vector &u) const
{
  const ContactNodes c = near_;
  const auto lambda = lambda_;
  const auto x = device_read(u);
  GO counts[3] = {0, 0, 0};
  Kokkos::parallel_reduce(
      "rpc::contact::count_states", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, GO &open, GO &stuck, GO &yielded) {
        if (c.fixed(i)) return;
        const State s = state(penetration(c, i, x), lambda(i), c.penalty(i), c.yield(i));
        open += s == State::open;
        stuck += s == State::stuck;
        yielded += s == State::yielded;
      },
      counts[0], counts[1], counts[2]);
  GO all[3];
  Teuchos::reduceAll(*comm_, Teuchos::REDUCE_SUM, 3, counts, all);
  return {all[0], all[1], all[2]};
}

double SmoothedFunctional::update_multipliers(const Vector &u)
{
  return replace_multipliers(*comm_, near_, pressures(near_, lambda_, u), lambda_);
}

double SmoothedFunctional::take_piece_pressures(const Vector &u)
{
  return replace_multipliers(*comm_, near_, piece_pressures(near_, lambda_, u, piece_), lambda_);
}

double SmoothedFunctional::pressure_error(const Vector &u) const
{
  const ContactNodes c = near_;
  const auto lambda = lambda_;
  const auto piece = piece_;
  const auto own = hessian_->own_stiffness();
  const auto x = device_read(u);
  double error = 0, largest = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::pressure_error", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &worst, double &scale) {
        if (c.fixed(i)) return;
        scale = larger(scale, lambda(i));
        if (piece(i) == State::stuck) worst = larger(worst, own(i) * magnitude(penetration(c, i, x)));
      },
      Kokkos::Max<double>(error), Kokkos::Max<double>(largest));
  const double mine[2] = {error, largest};
  double all[2];
  Teuchos::reduceAll(*comm_, Teuchos::REDUCE_MAX, 2, mine, all);
  return all[0] > 0 && all[1] > 0 ? all[0] / all[1] : 0;
}

double SmoothedFunctional::force_scale() const
{
  if (applied_force_ > 0) return applied_force_;
  const double contact_force = multiplier_forces().norm2();
  if (contact_force > 0) return contact_force;
  return lifted_force_ > 0 ? lifted_force_ : 1;
}

Vector SmoothedFunctional::multiplier_forces() const
{
  Vector force(problem_.load->getMap());
  add_contact_force(contact_, lambda_, force);
  return force;
}

double SmoothedFunctional::contact_law_residual(const Vector &u) const
{
  const ContactNodes c = contact_;
  const auto lambda = lambda_;
  const auto x = device_read(u);
  double violation = 0, largest = 0, deepest = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::law_residual", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &worst, double &pressure_scale, double &distance_scale) {
        if (c.fixed(i)) return;
        const double rho_v = c.stiffness(i) * penetration(c, i, x);
        const double p = lambda(i);
        const double miss = p - clamp(p + rho_v, 0, c.yield(i));
        worst = larger(worst, magnitude(miss));
        pressure_scale = larger(pressure_scale, p);
        distance_scale = larger(distance_scale, magnitude(rho_v));
      },
      Kokkos::Max<double>(violation), Kokkos::Max<double>(largest), Kokkos::Max<double>(deepest));
  const double mine[3] = {violation, largest, deepest};
  double all[3];
  Teuchos::reduceAll(*comm_, Teuchos::REDUCE_MAX, 3, mine, all);
  if (all[0] <= 0) return 0; // a maximum over no nodes is -DBL_MAX
  return all[0] / (all[1] > 0 ? all[1] : all[2]);
}

ContactEnergy SmoothedFunctional::contact_energy(const Vector &u) const
{
  const ContactNodes c = contact_;
  const auto lambda = lambda_;
  const auto x = device_read(u);
  double largest = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::largest_multiplier", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &most) { most = larger(most, lambda(i)); }, Kokkos::Max<double>(largest));
  const double bound = 2 * max_all(*comm_, std::max(0., largest));
  double sums[2] = {0, 0};
  Kokkos::parallel_reduce(
      "rpc::contact::contact_energy", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &dissipated, double &gap) {
        if (c.fixed(i)) return;
        const double v = penetration(c, i, x), xi = c.yield(i) < bound ? c.yield(i) : bound;
        dissipated += c.weight(i) * plastic_energy(v, lambda(i));
        gap += c.weight(i) * (plastic_energy(v, xi) - lambda(i) * v);
      },
      sums[0], sums[1]);
  double all[2];
  Teuchos::reduceAll(*comm_, Teuchos::REDUCE_SUM, 2, sums, all);
  return {all[0], all[1]};
}

} // namespace rpc::contact
