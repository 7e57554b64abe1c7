#include "rpc/contact/smoothed_functional.hpp"

#include "rpc/algebra/along_points.hpp"
#include "rpc/core/fingerprint.hpp"
#include "rpc/core/parallel.hpp"

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
// In units of E/diameter: weak enough not to slow Newton down once nodes close, strong against the rounding of K.
constexpr double weak_spring = 1e-4, weakest_spring = 1e-10, weaken = 1e-2;
constexpr double long_step = 1.1; // the step of a quadratic is 1
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
/// @param pressure_bound  above which a yield limit is out of reach [Pa]
void start_multipliers(const ContactNodes &c, const double pressure_bound, const DeviceView<double *> &lambda)
{
  Kokkos::parallel_for(
      "rpc::contact::start", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        const bool apart = c.scaling(i) * c.free_gap(i) > 1e-9 * c.yield(i); // more than rounding
        lambda(i) = c.fixed(i) || apart || c.yield(i) > pressure_bound || c.compliance(i) > 0 ? 0 : 0.5 * c.yield(i);
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

/// A copy whose penalties are chosen where they are left open, and bounded. (5.12)
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

/// (contact nodes) What the states add to K: the stiffness of the law's branch, and the weak spring where a node is not closed [Pa/m].
DeviceView<double *> added_stiffness(const ContactNodes &c, const DeviceView<State *> &active, const double spring)
{
  DeviceView<double *> added("rpc::contact::added", c.size());
  Kokkos::parallel_for(
      "rpc::contact::stiffen", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        if (c.fixed(i)) return;
        added(i) = branch_stiffness(active(i), c.penalty(i), foundation(c, i));
        if (active(i) != State::closed) added(i) += spring * c.scaling(i);
      });
  Kokkos::fence();
  return added;
}

/// (contact nodes, dim, dim) What is added to the blocks of K, a w m m^T.
DeviceView<double ***> added_blocks(const ContactNodes &c, const DeviceView<double *> &added)
{
  const DeviceView<double ***> block("rpc::contact::added_blocks", c.size(), c.dim, c.dim);
  Kokkos::parallel_for(
      "rpc::contact::added_blocks", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        for (int k = 0; k < c.dim; ++k)
          for (int l = 0; l < c.dim; ++l)
            block(i, k, l) = added(i) * c.weight(i) * c.direction(i, k) * c.direction(i, l);
      });
  Kokkos::fence();
  return block;
}

/// This rank's sum_i w_i Psi_i(v_i) (smoothed) or sum_i w_i (lambda_i v_i - psi_i*(lambda_i)).
double energy_at_nodes(const ContactNodes &c, const DeviceView<double *> &lambda, const Vector &u, const bool smoothed)
{
  const auto x = device_read(u);
  double sum = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::energy", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &part) {
        const double v = penetration(c, i, x);
        const Foundation f = foundation(c, i);
        if (c.fixed(i))
          part += c.weight(i) * foundation_energy(v, f);
        else
          part += c.weight(i) * (smoothed ? smoothed_energy(v, lambda(i), c.penalty(i), f)
                                          : lambda(i) * v - conjugate_energy(lambda(i), f));
      },
      sum);
  return sum;
}

/// F += sum_i w_i p_i m_i.
void add_contact_force(const ContactNodes &c, const DeviceView<double *> &p, Vector &F)
{
  const auto to = device_write(F);
  for_each_point_by_group(
      "rpc::contact::force", c, KOKKOS_LAMBDA(const LO i) {
        for (int k = 0; k < c.dim; ++k) to(c.dof(i, k)) += c.weight(i) * p(i) * c.direction(i, k);
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
      KOKKOS_LAMBDA(const LO i) { p(i) = pressure(penetration(c, i, x), lambda(i), c.penalty(i), foundation(c, i)); });
  return p;
}

/// (contact nodes) The pressures of an active set, whether the law admits them or not.
DeviceView<double *> active_set_pressures(const ContactNodes &c, const DeviceView<double *> &lambda, const Vector &u,
                                          const DeviceView<State *> &active)
{
  DeviceView<double *> p("rpc::contact::active_set_pressure", c.size());
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::active_set_pressure", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        p(i) = branch_pressure(active(i), penetration(c, i, x), lambda(i), c.penalty(i), foundation(c, i));
      });
  return p;
}

/// The first states: those of lambda + weight rho v, or all closed.
void first_states(const ContactNodes &c, const Vector &u, const DeviceView<double *> &lambda, const bool all_close,
                  const DeviceView<State *> &next)
{
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::first_states", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        const double rho = first_weight * c.scaling(i);
        next(i) = c.fixed(i)  ? State::open
                  : all_close ? State::closed
                              : state(penetration(c, i, x), lambda(i), rho, foundation(c, i));
      });
  Kokkos::fence();
}

/// This rank's largest pressure, as far as the law allows it [Pa].
double largest_pressure(const ContactNodes &c, const DeviceView<double *> &p)
{
  double largest = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::largest_pressure", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &most) { most = larger(most, admissible(p(i), foundation(c, i))); },
      Kokkos::Max<double>(largest));
  return std::max(0., largest);
}

/// A point that violates the contact law by more than a pressure goes from closed to open or yielding, else to closed. For a
/// penetration of an open point and a new dent, v - c p, of a yielding one stands k times that, with k the stiffness of the node alone.
void next_states(const ContactNodes &c, const Vector &u, const DeviceView<State *> &active,
                 const DeviceView<double *> &p, const DeviceView<double *> &own, const double bound,
                 const DeviceView<State *> &next)
{
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::next_states", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        next(i) = active(i);
        if (c.fixed(i)) return;
        const double dent = active(i) == State::yielding ? c.compliance(i) * p(i) : 0;
        const double kv = own(i) * (penetration(c, i, x) - dent);
        if (active(i) == State::closed)
          next(i) = p(i) < -bound ? State::open : p(i) > c.yield(i) + bound ? State::yielding : State::closed;
        else if ((active(i) == State::open ? kv : -kv) > bound)
          next(i) = State::closed;
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
          const double length = squared_length(c, i);
          move(i) = best_move(along_direction(c, i, slope) / length, stiffness(i), c.weight(i), penetration(c, i, x),
                              lambda(i), c.penalty(i), foundation(c, i)) /
                    length;
        });
    Kokkos::fence();
  }
  const auto x = device_write(u);
  for_each_point_by_group(
      "rpc::contact::move_points", c, KOKKOS_LAMBDA(const LO i) {
        for (int k = 0; k < c.dim; ++k) x(c.dof(i, k)) += move(i) * c.direction(i, k);
      });
  Kokkos::fence();
}

/// p <- p - q.
void subtract(const DeviceView<double *> &q, const DeviceView<double *> &p)
{
  Kokkos::parallel_for(
      "rpc::contact::subtract", device_range(static_cast<LO>(p.extent(0))),
      KOKKOS_LAMBDA(const LO i) { p(i) -= q(i); });
  Kokkos::fence();
}

/// u <- from at free unknowns.
void take_free(const fem::DirichletDofs &dirichlet, const Vector &from, Vector &u)
{
  const auto fixed = dirichlet.fixed;
  const auto source = device_read(from);
  const auto to = device_write(u);
  Kokkos::parallel_for(
      "rpc::contact::take_free", device_range(static_cast<LO>(u.getLocalLength())), KOKKOS_LAMBDA(const LO dof) {
        if (!fixed(dof)) to(dof) = source(dof);
      });
  Kokkos::fence();
}

/// lambda <- p, or the nearest pressure that the law admits. @return |change|_2 / |lambda|_2 over all ranks, 0 if nothing changed; collective
double replace_multipliers(const Comm &comm, const ContactNodes &c, const DeviceView<double *> &p,
                           const DeviceView<double *> &lambda)
{
  double sums[2] = {0, 0};
  Kokkos::parallel_reduce(
      "rpc::contact::replace_multipliers", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &change, double &size) {
        if (c.fixed(i)) return;
        const double next = admissible(p(i), foundation(c, i));
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
  return sum_of_bits(comm, sum);
}

/// What the contact points add to the gradient on a subspace, then to the rows of the curvature, one after the other.
struct SubspaceSums {
  using value_type = double[];
  using size_type = LO;
  const size_type value_count; // n + n n, for n directions
  ContactNodes contact;
  DeviceView<double *> v;
  DeviceView<double **> dv;
  DeviceView<double *> lambda, coefficient;

  SubspaceSums(const ContactNodes &points, const DeviceView<double *> &at, const DeviceView<double **> &moves,
               const DeviceView<double *> &multiplier, const DeviceView<double *> &a)
      : value_count(static_cast<size_type>(a.extent(0) * (a.extent(0) + 1))), contact(points), v(at), dv(moves),
        lambda(multiplier), coefficient(a)
  {
  }
  KOKKOS_INLINE_FUNCTION void operator()(const LO i, double sum[]) const
  {
    const LO n = static_cast<LO>(coefficient.extent(0));
    const Foundation f = foundation(contact, i);
    const double r = contact.penalty(i), w = contact.weight(i);
    double moved = v(i);
    for (LO k = 0; k < n; ++k) moved += dv(i, k) * coefficient(k);
    const double change = w * (pressure(moved, lambda(i), r, f) - pressure(v(i), lambda(i), r, f));
    const double stiffness = w * branch_stiffness(state(moved, lambda(i), r, f), r, f);
    for (LO k = 0; k < n; ++k) {
      sum[k] += change * dv(i, k);
      for (LO l = 0; l < n; ++l) sum[n + n * k + l] += stiffness * dv(i, k) * dv(i, l);
    }
  }
  KOKKOS_INLINE_FUNCTION void init(double sum[]) const
  {
    for (size_type k = 0; k < value_count; ++k) sum[k] = 0;
  }
  KOKKOS_INLINE_FUNCTION void join(double sum[], const double part[]) const
  {
    for (size_type k = 0; k < value_count; ++k) sum[k] += part[k];
  }
};

} // namespace

SubspaceModel::SubspaceModel(RCP<const Comm> comm, std::vector<double> at_0, std::vector<double> elastic,
                             const ContactNodes &contact, DeviceView<double *> v, DeviceView<double **> dv,
                             DeviceView<double *> lambda)
    : comm_(std::move(comm)), at_0_(std::move(at_0)), elastic_(std::move(elastic)), contact_(contact), v_(std::move(v)),
      dv_(std::move(dv)), lambda_(std::move(lambda))
{
}

SubspaceModel::Value SubspaceModel::at(const std::vector<double> &a) const
{
  const std::size_t n = a.size();
  HostView<double *> given("rpc::contact::coefficients", n);
  std::copy(a.begin(), a.end(), given.data());
  const SubspaceSums sums(contact_, v_, dv_, lambda_, to_device(given));
  std::vector<double> mine(n * (n + 1));
  Kokkos::parallel_reduce("rpc::contact::subspace_model", device_range(contact_.size()), sums, mine.data());
  Kokkos::fence();
  const auto all = summed(*comm_, mine);
  Value value{at_0_, elastic_};
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t l = 0; l < n; ++l) value.gradient[k] += elastic_[n * k + l] * a[l];
    value.gradient[k] += all[k];
  }
  for (std::size_t k = 0; k < n * n; ++k) value.curvature[k] += all[n + k];
  return value;
}

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
        const Foundation f = foundation(c, i);
        const double r = c.penalty(i), moved = v(i) + t * dv(i);
        slope += c.weight(i) * dv(i) * (pressure(moved, lambda(i), r, f) - pressure(v(i), lambda(i), r, f));
        curvature += c.weight(i) * branch_stiffness(state(moved, lambda(i), r, f), r, f) * dv(i) * dv(i);
      },
      sums[0], sums[1]);
  double all[2];
  Teuchos::reduceAll(*comm_, Teuchos::REDUCE_SUM, 2, sums, all);
  return {slope_at_0_ + elastic_curvature_ * t + all[0], elastic_curvature_ + all[1]};
}

SmoothedFunctional::SmoothedFunctional(fem::ElasticProblem problem, ContactNodes contact, RCP<UpdatedOperator> hessian)
    : comm_(hessian->getDomainMap()->getComm()), problem_(std::move(problem)), contact_(std::move(contact)),
      lambda_("rpc::contact::multiplier", contact_.size()), active_set_("rpc::contact::active_set", contact_.size()),
      hessian_(std::move(hessian)), own_(own_stiffness(hessian_->base(), contact_)),
      coupled_(coupled_stiffness(hessian_->base(), contact_))
{
  Vector applied(*problem_.applied_load, Teuchos::Copy), lifted(*problem_.load, Teuchos::Copy);
  fem::clear_prescribed(problem_.dirichlet, applied);
  fem::clear_prescribed(problem_.dirichlet, lifted);
  applied_force_ = applied.norm2();
  prescribed_force_ = lifted.norm2();
  const double weight = sum_all(*comm_, free_weight(contact_));
  pressure_bound_ = weight > 0 ? beyond_reach * lifted.norm1() / weight : 0;
  reset_multipliers();
  contact_ = with_penalties(contact_, own_);
  shifted_ = contact_;
  load_ = problem_.load;
}

void SmoothedFunctional::hold_by_contact()
{
  spring_ = weak_spring;
}

void SmoothedFunctional::step_taken(const double length)
{
  if (length > long_step && spring_ > 0) spring_ = std::max(weaken * spring_, weakest_spring);
}

bool SmoothedFunctional::raise_penalty()
{
  const ContactNodes c = contact_;
  const auto own = own_;
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
  return hessian_->set(contact_, added_blocks(contact_, added_stiffness(contact_, active_set_, spring_)));
}

void SmoothedFunctional::start_from(const ContactState &state, Vector &u)
{
  warm_start_ = true;
  take_free(problem_.dirichlet, *state.displacement, u);
  if (state.multiplier.extent(0) == 0) return; // no contact node on this rank
  const ContactNodes c = contact_;
  const auto from = state.multiplier, to = lambda_;
  Kokkos::parallel_for(
      "rpc::contact::start_from", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i) { to(i) = c.fixed(i) ? 0 : admissible(from(i), foundation(c, i)); });
  Kokkos::fence();
}

void SmoothedFunctional::reset_multipliers()
{
  if (prescribed_force_ > 0)
    start_multipliers(contact_, pressure_bound_, lambda_); // else nothing acts, and lambda = 0 is the solution
  warm_start_ = false;
}

void SmoothedFunctional::move_origin(Vector &u)
{
  const auto moved = rcp(new Vector(*load_, Teuchos::Copy));
  Vector Ku(u.getMap());
  hessian_->apply_base(u, Ku);
  moved->update(-1., Ku, 1.);
  load_ = moved;
  shifted_.free_gap = left_of_gap(shifted_, u);
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
  hessian_->apply_base(u, Ku);
  return 0.5 * u.dot(Ku) - load_->dot(u) + problem_.energy_offset +
         sum_all(*comm_, energy_at_nodes(shifted_, lambda_, u, true));
}

double SmoothedFunctional::energy(const Vector &u) const
{
  Vector Ku(u.getMap());
  hessian_->apply_base(u, Ku);
  return 0.5 * u.dot(Ku) - problem_.load->dot(u) + problem_.energy_offset +
         sum_all(*comm_, energy_at_nodes(contact_, lambda_, u, false));
}

void SmoothedFunctional::gradient(const Vector &u, Vector &F) const
{
  elastic_gradient(u, F);
  add_contact_force(shifted_, pressures(shifted_, lambda_, u), F);
}

void SmoothedFunctional::elastic_gradient(const Vector &u, Vector &G) const
{
  hessian_->apply_base(u, G);
  G.update(-1., *load_, 1.);
}

void SmoothedFunctional::active_set_gradient(const Vector &u, const Vector &gradient, Vector &F) const
{
  const auto p = active_set_pressures(shifted_, lambda_, u, active_set_);
  subtract(pressures(shifted_, lambda_, u), p);
  F.update(1., gradient, 0.);
  add_contact_force(shifted_, p, F);
}

void SmoothedFunctional::sweep(Vector &u) const
{
  Vector G(u.getMap());
  elastic_gradient(u, G);
  move_points(shifted_, lambda_, coupled_, G, u);
}

GO SmoothedFunctional::update_hessian(const Vector &u)
{
  const ContactNodes c = shifted_;
  const auto lambda = lambda_;
  const auto active = active_set_;
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::update_hessian", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        if (!c.fixed(i)) active(i) = state(penetration(c, i, x), lambda(i), c.penalty(i), foundation(c, i));
      });
  has_active_set_ = true;
  return update_stiffness();
}

ActiveSetChoice SmoothedFunctional::choose_active_set(const Vector &u, const double negligible) const
{
  const ContactNodes c = shifted_;
  const DeviceView<State *> next("rpc::contact::next_state", c.size());
  ActiveSetChoice choice{next, lambda_};
  if (has_active_set_) {
    choice.pressure = active_set_pressures(c, lambda_, u, active_set_);
    const double bound = negligible * max_all(*comm_, largest_pressure(c, choice.pressure));
    next_states(c, u, active_set_, choice.pressure, own_, bound, next);
  } else {
    first_states(c, u, lambda_, spring_ > 0 && !warm_start_, next);
  }
  choice.changes = sum_all(*comm_, GO(count_differences(next, active_set_)));
  choice.confirmed = choice.changes == 0 && has_active_set_;
  choice.fingerprint = fingerprint_of(*comm_, c, next);
  return choice;
}

void SmoothedFunctional::take_active_set(const ActiveSetChoice &choice, Vector &u)
{
  const ContactNodes c = shifted_;
  const auto lambda = lambda_;
  const auto active = active_set_;
  const auto next = choice.state;
  const auto p = choice.pressure;
  has_active_set_ = true;
  const auto x = device_write(u);
  for_each_point_by_group( // a node of two sides is moved for one after the other
      "rpc::contact::take_active_set", c, KOKKOS_LAMBDA(const LO i) {
        if (c.fixed(i)) return;
        const Foundation f = foundation(c, i);
        const bool closes = next(i) == State::closed && active(i) != State::closed;
        active(i) = next(i);
        if (next(i) == State::closed)
          lambda(i) = clamp(p(i), 0, f.yield);
        else
          lambda(i) = next(i) == State::open ? 0 : larger(f.yield, admissible(p(i), f));
        if (!closes) return;
        const double move = (penetration(c, i, x) - f.compliance * lambda(i)) / squared_length(c, i);
        for (int k = 0; k < c.dim; ++k) x(c.dof(i, k)) -= move * c.direction(i, k);
      });
  Kokkos::fence();
  update_stiffness();
}

std::unique_ptr<LineFunction> SmoothedFunctional::along(const Vector &u, const Vector &d, const Vector &F) const
{
  Vector Kd(d.getMap());
  hessian_->apply_base(d, Kd);
  const ContactNodes c = shifted_;
  DeviceView<double *> v("rpc::contact::v", c.size()), dv("rpc::contact::dv", c.size());
  const auto from = device_read(u);
  const auto step = device_read(d);
  Kokkos::parallel_for(
      "rpc::contact::along", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        v(i) = penetration(c, i, from);
        dv(i) = along_direction(c, i, step);
      });
  Kokkos::fence();
  return std::make_unique<LineModel>(comm_, d.dot(F), d.dot(Kd), shifted_, v, dv, lambda_);
}

std::unique_ptr<SubspaceFunction>
SmoothedFunctional::within(const Vector &u, const std::vector<RCP<const Vector>> &directions, const Vector &F) const
{
  const ContactNodes c = shifted_;
  const std::size_t n = directions.size();
  std::vector<double> at_0(n), elastic(n * n);
  DeviceView<double *> v("rpc::contact::v", c.size());
  DeviceView<double **> dv("rpc::contact::dv", c.size(), n);
  const auto from = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::within", device_range(c.size()), KOKKOS_LAMBDA(const LO i) { v(i) = penetration(c, i, from); });
  Vector Kd(u.getMap());
  for (std::size_t k = 0; k < n; ++k) {
    const Vector &d = *directions[k];
    hessian_->apply_base(d, Kd);
    for (std::size_t l = 0; l <= k; ++l) elastic[n * k + l] = elastic[n * l + k] = Kd.dot(*directions[l]);
    at_0[k] = d.dot(F);
    const auto step = device_read(d);
    Kokkos::parallel_for(
        "rpc::contact::within", device_range(c.size()),
        KOKKOS_LAMBDA(const LO i) { dv(i, k) = along_direction(c, i, step); });
    Kokkos::fence();
  }
  return std::make_unique<SubspaceModel>(comm_, at_0, elastic, shifted_, v, dv, lambda_);
}

StateCounts SmoothedFunctional::count_states(const Vector &u) const
{
  const ContactNodes c = shifted_;
  const auto lambda = lambda_;
  const auto x = device_read(u);
  GO counts[3] = {0, 0, 0};
  Kokkos::parallel_reduce(
      "rpc::contact::count_states", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, GO &open, GO &closed, GO &yielding) {
        if (c.fixed(i)) return;
        const State s = state(penetration(c, i, x), lambda(i), c.penalty(i), foundation(c, i));
        open += s == State::open;
        closed += s == State::closed;
        yielding += s == State::yielding;
      },
      counts[0], counts[1], counts[2]);
  GO all[3];
  Teuchos::reduceAll(*comm_, Teuchos::REDUCE_SUM, 3, counts, all);
  return {all[0], all[1], all[2]};
}

std::uint64_t SmoothedFunctional::piece(const Vector &u) const
{
  const StateCounts counts = count_states(u);
  return scrambled(scrambled(static_cast<std::uint64_t>(counts.open)) + static_cast<std::uint64_t>(counts.closed));
}

double SmoothedFunctional::size(const Vector &u) const
{
  return displacement(u).norm2();
}

ContactState SmoothedFunctional::current(const RCP<const Vector> &u) const
{
  ContactState copy{u, DeviceView<double *>("rpc::contact::multiplier", contact_.size()),
                    DeviceView<State *>("rpc::contact::active_set", contact_.size())};
  Kokkos::deep_copy(copy.multiplier, lambda_);
  Kokkos::deep_copy(copy.active_set, active_set_);
  return copy;
}

double SmoothedFunctional::update_multipliers(const Vector &u)
{
  return replace_multipliers(*comm_, shifted_, pressures(shifted_, lambda_, u), lambda_);
}

double SmoothedFunctional::take_active_set_pressures(const Vector &u)
{
  return replace_multipliers(*comm_, shifted_, active_set_pressures(shifted_, lambda_, u, active_set_), lambda_);
}

double SmoothedFunctional::pressure_error(const Vector &u) const
{
  const ContactNodes c = shifted_;
  const auto lambda = lambda_;
  const auto active = active_set_;
  const auto own = own_;
  const auto x = device_read(u);
  double error = 0, largest = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::pressure_error", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &worst, double &scale) {
        if (c.fixed(i)) return;
        scale = larger(scale, lambda(i));
        // What the penalty is stretched by, (p - lambda)/r; of a closed point on a rigid foundation v.
        const double v = penetration(c, i, x), r = c.penalty(i);
        const Foundation f = foundation(c, i);
        if (active(i) == State::closed)
          worst = larger(worst, own(i) * magnitude((v - f.compliance * lambda(i)) / softening(r, f)));
        else if (active(i) == State::yielding && f.hardening > 0)
          worst =
              larger(worst, own(i) * magnitude(branch_pressure(State::yielding, v, lambda(i), r, f) - lambda(i)) / r);
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
  return prescribed_force_ > 0 ? prescribed_force_ : 1;
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
        const double v = penetration(c, i, x), p = lambda(i);
        const Foundation f = foundation(c, i);
        const double rho = c.scaling(i) + f.hardening; // a softer one would see less of what a stiff foundation misses
        const double miss = p - pressure(v, p, rho, f);
        worst = larger(worst, magnitude(miss));
        pressure_scale = larger(pressure_scale, p);
        distance_scale = larger(distance_scale, magnitude(c.scaling(i) * v));
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
      KOKKOS_LAMBDA(const LO i, double &dissipated, double &duality_gap) {
        if (c.fixed(i)) return;
        const double v = penetration(c, i, x), p = lambda(i);
        Foundation f = foundation(c, i);
        const double dent = v - f.compliance * p;
        if (dent > 0) dissipated += c.weight(i) * larger(0, dissipation(dent, p, f));
        if (f.yield > bound) f.yield = bound;
        duality_gap += c.weight(i) * (foundation_energy(v, f) + conjugate_energy(p, f) - p * v);
      },
      sums[0], sums[1]);
  double all[2];
  Teuchos::reduceAll(*comm_, Teuchos::REDUCE_SUM, 2, sums, all);
  return {all[0], all[1]};
}

} // namespace rpc::contact
