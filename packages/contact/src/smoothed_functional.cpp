#include "rpc/contact/smoothed_functional.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rpc::contact
{

// Kernels are free functions: nvcc takes no device lambda in a constructor or a private member.
namespace
{

KOKKOS_INLINE_FUNCTION double larger(const double a, const double b)
{
  return a > b ? a : b;
}
KOKKOS_INLINE_FUNCTION double magnitude(const double x)
{
  return x < 0 ? -x : x;
}

/// The paper's start l = 0, which is half the yield limit, where the body touches; a rigid foundation has no half. Where
/// there is a gap no pressure is the better guess.
void start_multipliers(const ContactNodes &c, const DeviceView<double *> &lambda)
{
  Kokkos::parallel_for(
      "rpc::contact::start", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        lambda(i) = c.fixed(i) || is_rigid(c.yield(i)) || c.free_gap(i) > 0 ? 0 : 0.5 * c.yield(i);
      });
}

/// |v|_2 over the unknowns that are free.
double free_norm(const fem::ElasticProblem &problem, const Vector &v)
{
  Vector free(v, Teuchos::Copy);
  {
    const auto fixed = problem.dirichlet.fixed;
    const auto to = device_write(free);
    Kokkos::parallel_for(
        "rpc::contact::free_part", device_range(static_cast<LO>(v.getLocalLength())), KOKKOS_LAMBDA(const LO dof) {
          if (fixed(dof)) to(dof) = 0;
        });
    Kokkos::fence();
  }
  return free.norm2();
}

/// Where each contact node's own block of K lies, and what it holds.
void find_diagonal_blocks(const ContactNodes &c, const CrsMatrix &K, const DeviceView<std::size_t **> &block,
                          const DeviceView<double ***> &elastic)
{
  const auto A = K.getLocalMatrixDevice();
  Kokkos::parallel_for(
      "rpc::contact::find_blocks", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        for (int k = 0; k < c.dim; ++k) {
          const LO row = c.dim * c.node(i) + k;
          std::size_t at = A.graph.row_map(row);
          while (A.graph.entries(at) != c.dim * c.node(i)) ++at; // an owned node's first column has its first row's lid
          block(i, k) = at;
          for (int l = 0; l < c.dim; ++l) elastic(i, k, l) = A.values(at + l);
        }
      });
  Kokkos::fence();
}

/// Brings the contact nodes' own blocks to those of K + sum over stuck points, r w m m^T. All of them, for a node of two
/// sides is two points with one block.
void write_diagonal_blocks(const ContactNodes &c, const DeviceView<State *> &piece,
                           const DeviceView<std::size_t **> &block, const DeviceView<double ***> &elastic, CrsMatrix &H)
{
  const auto values = H.getLocalMatrixDevice().values;
  Kokkos::parallel_for(
      "rpc::contact::elastic_blocks", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        for (int k = 0; k < c.dim; ++k)
          for (int l = 0; l < c.dim; ++l) values(block(i, k) + l) = elastic(i, k, l);
      });
  Kokkos::parallel_for(
      "rpc::contact::stuck_blocks", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        if (piece(i) != State::stuck) return;
        for (int k = 0; k < c.dim; ++k)
          for (int l = 0; l < c.dim; ++l)
            add_shared(values(block(i, k) + l), c.penalty(i) * c.weight(i) * c.direction(i, k) * c.direction(i, l));
      });
  Kokkos::fence();
}

/// Ku -= sum over nodes whose block is in the matrix, r w m (m . u).
void subtract_contact(const ContactNodes &c, const DeviceView<State *> &piece, const Vector &u, Vector &Ku)
{
  const auto from = device_read(u);
  const auto to = device_write(Ku);
  Kokkos::parallel_for(
      "rpc::contact::without_contact", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        if (piece(i) != State::stuck) return;
        const double along = along_direction(c, i, from);
        for (int k = 0; k < c.dim; ++k) // a node of two sides is two points
          add_shared(to(c.dim * c.node(i) + k), -c.penalty(i) * c.weight(i) * along * c.direction(i, k));
      });
  Kokkos::fence();
}

/// This rank's sum_i w_i Psi_i(v_i) (smoothed) or sum_i w_i lambda_i v_i.
double contact_energy(const ContactNodes &c, const DeviceView<double *> &lambda, const Vector &u, const bool smoothed)
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
  Kokkos::parallel_for(
      "rpc::contact::force", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        for (int k = 0; k < c.dim; ++k) add_shared(to(c.dim * c.node(i) + k), c.weight(i) * p(i) * c.direction(i, k));
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
      block_("rpc::contact::block", contact_.size(), contact_.dim),
      elastic_("rpc::contact::elastic", contact_.size(), contact_.dim, contact_.dim)
{
  applied_force_ = free_norm(problem_, *problem_.applied_load);
  lifted_force_ = free_norm(problem_, *problem_.load);
  reset_multipliers();
  find_diagonal_blocks(contact_, *problem_.stiffness, block_, elastic_);
}

void SmoothedFunctional::reset_multipliers()
{
  if (lifted_force_ > 0) start_multipliers(contact_, lambda_); // else nothing acts, and lambda = 0 is the solution
}

void SmoothedFunctional::apply_stiffness(const Vector &u, Vector &Ku) const
{
  problem_.stiffness->apply(u, Ku);
  subtract_contact(contact_, piece_, u, Ku);
}

double SmoothedFunctional::potential(const Vector &u) const
{
  Vector Ku(u.getMap());
  apply_stiffness(u, Ku);
  return 0.5 * u.dot(Ku) - problem_.load->dot(u) + problem_.energy_offset;
}

double SmoothedFunctional::value(const Vector &u) const
{
  return potential(u) + sum_all(*comm_, contact_energy(contact_, lambda_, u, true));
}

double SmoothedFunctional::energy(const Vector &u) const
{
  return potential(u) + sum_all(*comm_, contact_energy(contact_, lambda_, u, false));
}

void SmoothedFunctional::gradient(const Vector &u, Vector &F) const
{
  apply_stiffness(u, F);
  F.update(-1., *problem_.load, 1.);
  add_contact_force(contact_, pressures(contact_, lambda_, u), F);
}

void SmoothedFunctional::piece_gradient(const Vector &u, Vector &F) const
{
  apply_stiffness(u, F);
  F.update(-1., *problem_.load, 1.);
  add_contact_force(contact_, piece_pressures(contact_, lambda_, u, piece_), F);
}

GO SmoothedFunctional::update_hessian(const Vector &u)
{
  const ContactNodes c = contact_;
  const auto lambda = lambda_;
  const auto piece = piece_;
  const auto x = device_read(u);
  LO changed = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::update_hessian", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, LO &count) {
        if (c.fixed(i)) return;
        const State now = state(penetration(c, i, x), lambda(i), c.penalty(i), c.yield(i));
        count += (now == State::stuck) != (piece(i) == State::stuck);
        piece(i) = now;
      },
      changed);
  piece_chosen_ = true;
  if (changed > 0) write_diagonal_blocks(c, piece, block_, elastic_, *problem_.stiffness);
  return sum_all(*comm_, GO(changed));
}

StateChange SmoothedFunctional::choose_states(const Vector &u, const double rho)
{
  const ContactNodes c = contact_;
  const auto lambda = lambda_;
  const auto piece = piece_;
  const bool chosen = piece_chosen_;
  const auto p = chosen ? piece_pressures(c, lambda, u, piece) : lambda;
  const DeviceView<State *> next("rpc::contact::next_state", c.size());
  LO changed = 0, stiffness = 0;
  {
    const auto x = device_read(u);
    Kokkos::parallel_reduce(
        "rpc::contact::choose_states", device_range(c.size()),
        KOKKOS_LAMBDA(const LO i, LO &nodes, LO &blocks) {
          // What the penalty leaves of v at a stuck node says nothing.
          const double v = chosen && piece(i) == State::stuck ? 0 : penetration(c, i, x);
          next(i) = c.fixed(i) ? piece(i) : state(v, p(i), rho, c.yield(i));
          nodes += next(i) != piece(i);
          blocks += (next(i) == State::stuck) != (piece(i) == State::stuck);
        },
        changed, stiffness);
  }
  const GO mine[2] = {changed, stiffness};
  GO all[2];
  Teuchos::reduceAll(*comm_, Teuchos::REDUCE_SUM, 2, mine, all);
  StateChange change{all[0], all[1], fingerprint_of(*comm_, c, next)};
  if (change.nodes == 0 && chosen) return change;
  piece_chosen_ = true;
  Kokkos::parallel_for(
      "rpc::contact::take_states", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        if (c.fixed(i)) return;
        piece(i) = next(i);
        if (next(i) == State::stuck)
          lambda(i) = clamp(p(i), 0, c.yield(i));
        else
          lambda(i) = next(i) == State::yielded ? c.yield(i) : 0;
      });
  Kokkos::fence();
  if (change.stiffness > 0) write_diagonal_blocks(c, piece, block_, elastic_, *problem_.stiffness);
  return change;
}

LineModel SmoothedFunctional::along(const Vector &u, const Vector &d, const Vector &F) const
{
  Vector Kd(d.getMap());
  apply_stiffness(d, Kd);
  const ContactNodes c = contact_;
  DeviceView<double *> v("rpc::contact::v", c.size()), dv("rpc::contact::dv", c.size());
  const auto from = device_read(u);
  const auto step = device_read(d);
  Kokkos::parallel_for(
      "rpc::contact::along", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        v(i) = penetration(c, i, from);
        dv(i) = along_direction(c, i, step);
      });
  Kokkos::fence();
  return LineModel(comm_, d.dot(F), d.dot(Kd), contact_, v, dv, lambda_);
}

StateCounts SmoothedFunctional::count_states(const Vector &u) const
{
  const ContactNodes c = contact_;
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
  const ContactNodes c = contact_;
  const auto lambda = lambda_;
  const auto x = device_read(u);
  double sums[2] = {0, 0};
  Kokkos::parallel_reduce(
      "rpc::contact::update_multipliers", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &change, double &size) {
        if (c.fixed(i)) return;
        const double next = pressure(penetration(c, i, x), lambda(i), c.penalty(i), c.yield(i));
        change += (next - lambda(i)) * (next - lambda(i));
        size += next * next;
        lambda(i) = next;
      },
      sums[0], sums[1]);
  double all[2];
  Teuchos::reduceAll(*comm_, Teuchos::REDUCE_SUM, 2, sums, all);
  if (all[0] == 0) return 0;
  return std::sqrt(all[0] / std::max(all[1], all[0])); // all multipliers gone to zero is a change of 1, not of infinity
}

double SmoothedFunctional::force_scale() const
{
  if (applied_force_ > 0) return applied_force_;
  Vector contact(problem_.load->getMap());
  add_contact_force(contact_, lambda_, contact);
  const double contact_force = contact.norm2();
  if (contact_force > 0) return contact_force;
  return lifted_force_ > 0 ? lifted_force_ : 1;
}

double SmoothedFunctional::equilibrium_residual(const Vector &u) const
{
  Vector contact(u.getMap()), F(u.getMap());
  add_contact_force(contact_, lambda_, contact);
  apply_stiffness(u, F);
  F.update(-1., *problem_.load, 1., contact, 1.);
  return F.norm2() / std::max(force_scale(), contact.norm2());
}

double SmoothedFunctional::contact_law_residual(const Vector &u, const double stiffness_scale) const
{
  const ContactNodes c = contact_;
  const auto lambda = lambda_;
  const auto x = device_read(u);
  double violation = 0, largest = 0, deepest = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::law_residual", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &worst, double &pressure_scale, double &distance_scale) {
        if (c.fixed(i)) return;
        const double rho_v = stiffness_scale * penetration(c, i, x);
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

} // namespace rpc::contact
