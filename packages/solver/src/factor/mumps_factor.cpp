// SPDX-License-Identifier: BSD-3-Clause
#include "factor/mumps_factor.hpp"

#include "krylov/interrupted.hpp"
#include "rpc/core/interrupt.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/solver/rules.hpp"

#include <Teuchos_DefaultMpiComm.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <dmumps_c.h>
#include <metis.h>
#include <new>
#include <stdexcept>
#include <utility>

namespace rpc::solver
{
namespace
{

// Numbers of MUMPS' manual, from 0.
enum Control {
  error_unit = 0,
  last_unit = 2,
  verbosity = 3,
  scaling = 7,
  given_order = 6,
  zero_free = 5,
  refinement = 9,
  more_memory = 13,
  input = 17,
  right_side = 19
};
enum Info { status = 0, entries_of_factor = 2, num_negative = 11, megabytes = 15 };
enum Job : int { begin = -1, end = -2, analysis = 1, factorization = 2, solution = 3 };
constexpr int by_hand = 1, on_all_ranks = 3, is_definite = 1, dense = 0, sparse = 3;
constexpr int first_more_memory = 20;      // per cent of what the analysis has found
constexpr double seconds_of_interrupt = 1; // that one may wait: a factor of less is made in this thread [s]
// What MUMPS answers.
constexpr int too_little_memory[] = {-8, -9, -14, -15, -17, -19, -20}, out_of_memory = -13, singular = -10,
              not_definite_root = -40;

MPI_Comm raw(const Comm &comm)
{
  if (comm.getSize() == 1) return MPI_COMM_SELF;
  return *dynamic_cast<const Teuchos::MpiComm<int> &>(comm).getRawMpiComm();
}

/// (nodes) Each node's place in METIS' order of nested dissection, on rank 0; collective.
/// @param entries  of this rank, of rows and columns of unknowns
std::vector<idx_t> nested_dissection(const Comm &comm, const int num_nodes, const SymmetricEntries &entries,
                                     const int dofs_per_node)
{
  std::vector<std::int64_t> mine; // pairs of nodes, each in both orders
  for (std::size_t e = 0; e < entries.row.size(); ++e) {
    const std::int64_t a = entries.row[e] / dofs_per_node, b = entries.column[e] / dofs_per_node;
    if (a == b || entries.row[e] % dofs_per_node != 0 || entries.column[e] % dofs_per_node != 0) continue;
    mine.push_back(a * num_nodes + b);
    mine.push_back(b * num_nodes + a);
  }
  std::sort(mine.begin(), mine.end());
  mine.erase(std::unique(mine.begin(), mine.end()), mine.end());
  std::vector<std::int64_t> pairs = gathered_by_root(comm, mine);
  if (comm.getRank() != 0) return {};
  if (comm.getSize() > 1) {
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  }
  std::vector<idx_t> begin(num_nodes + 1, 0), neighbour(pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    ++begin[pairs[k] / num_nodes + 1];
    neighbour[k] = static_cast<idx_t>(pairs[k] % num_nodes);
  }
  for (int n = 0; n < num_nodes; ++n) begin[n + 1] += begin[n];
  idx_t options[METIS_NOPTIONS], n = num_nodes;
  METIS_SetDefaultOptions(options);
  std::vector<idx_t> order(num_nodes), place(num_nodes);
  if (METIS_NodeND(&n, begin.data(), neighbour.data(), nullptr, options, order.data(), place.data()) != METIS_OK)
    for (int i = 0; i < num_nodes; ++i) place[i] = i;
  return place;
}

} // namespace

struct MumpsFactor::Impl {
  DMUMPS_STRUC_C mumps{};
  int size = 0;
  std::vector<std::size_t> from; // (own entries on and below the diagonal) which of the given ones
  std::vector<int> row, column;  // (the same) from 1
  std::vector<double> value;     // (the same)
  std::vector<int> place;        // (size) on rank 0, from 1
  bool exists = false;

  void call(const int job)
  {
    mumps.job = job;
    dmumps_c(&mumps);
  }
  /// MUMPS' last answer, the same on all ranks; 0 is good.
  int answer() const { return std::min(mumps.infog[status], 0); }
  /// The same, of a job. MUMPS' globals belong to the work that an interrupt has left behind, if there is any.
  int run(const int job)
  {
    if (work_goes_on()) throw Interrupted();
    call(job);
    return answer();
  }
  /// X <- A^-1 times the right sides. @param x  (columns, size) on rank 0
  void solve(double *const x, const int columns)
  {
    mumps.rhs = x;
    mumps.nrhs = columns;
    mumps.lrhs = size;
    if (const int answer = run(solution); answer == out_of_memory)
      throw std::bad_alloc();
    else if (answer != 0)
      throw std::runtime_error("the sparse factor: MUMPS' solution ends with " + std::to_string(answer));
  }
  ~Impl()
  {
    if (!work_goes_on()) call(end);
  }
};

MumpsFactor::MumpsFactor(RCP<const Comm> comm, const int size, const SymmetricEntries &entries, const int dofs_per_node)
    : comm_(std::move(comm)), impl_(std::make_shared<Impl>())
{
  Impl &impl = *impl_;
  impl.size = size;
  auto &mumps = impl.mumps;
  mumps.comm_fortran = static_cast<MUMPS_INT>(MPI_Comm_c2f(raw(*comm_)));
  mumps.par = 1;
  mumps.sym = is_definite;
  if (impl.run(begin) != 0) throw std::runtime_error("the sparse factor: MUMPS cannot be started");
  for (int unit = error_unit; unit <= last_unit; ++unit) mumps.icntl[unit] = -1;
  mumps.icntl[verbosity] = 0;
  mumps.icntl[zero_free] = mumps.icntl[scaling] = mumps.icntl[refinement] = 0;
  mumps.icntl[given_order] = by_hand;
  mumps.icntl[more_memory] = first_more_memory;
  for (std::size_t e = 0; e < entries.row.size(); ++e) {
    if (entries.row[e] < entries.column[e]) continue;
    impl.from.push_back(e);
    impl.row.push_back(entries.row[e] + 1);
    impl.column.push_back(entries.column[e] + 1);
  }
  impl.value.resize(impl.from.size());
  const std::vector<idx_t> of_nodes = nested_dissection(*comm_, size / dofs_per_node, entries, dofs_per_node);
  for (const idx_t node : of_nodes)
    for (int k = 0; k < dofs_per_node; ++k) impl.place.push_back(static_cast<int>(node) * dofs_per_node + k + 1);
  mumps.n = size;
  mumps.perm_in = impl.place.data();
  if (comm_->getSize() > 1) {
    mumps.icntl[input] = on_all_ranks;
    mumps.nnz_loc = static_cast<MUMPS_INT8>(impl.row.size());
    mumps.irn_loc = impl.row.data();
    mumps.jcn_loc = impl.column.data();
    mumps.a_loc = impl.value.data();
  } else {
    mumps.nnz = static_cast<MUMPS_INT8>(impl.row.size());
    mumps.irn = impl.row.data();
    mumps.jcn = impl.column.data();
    mumps.a = impl.value.data();
  }
  const int answer = impl.run(analysis);
  if (answer == out_of_memory) throw std::bad_alloc();
  if (answer != 0) throw std::runtime_error("the sparse factor: MUMPS' analysis ends with " + std::to_string(answer));
}

MumpsFactor::~MumpsFactor() = default;

FactorCost MumpsFactor::cost() const
{
  const auto &mumps = impl_->mumps;
  FactorCost cost;
  cost.gain_of_ranks = std::pow(comm_->getSize(), double(cost_model.gain));
  cost.operations = mumps.rinfog[0];
  const double entries = mumps.infog[entries_of_factor];
  cost.entries = entries < 0 ? -1e6 * entries : entries;
  cost.bytes = 1e6 * mumps.infog[megabytes];
  cost.seconds = (cost_model.dense * cost.operations + cost_model.factor_entry * cost.entries) / cost.gain_of_ranks;
  cost.seconds_of_solve = cost_model.factor_entry_in_solve * cost.entries / cost.gain_of_ranks;
  cost.seconds_of_column = cost.seconds_of_solve / cost_model.columns_for_one;
  return cost;
}

bool MumpsFactor::exists() const
{
  return impl_->exists;
}

bool MumpsFactor::make(const std::vector<double> &value)
{
  impl_->exists = false;
  for (std::size_t k = 0; k < impl_->from.size(); ++k) impl_->value[k] = value[impl_->from[k]];
  int answer = 0;
  do {
    const auto impl = impl_;
    if (work_goes_on()) throw Interrupted();
    const auto work = [impl] { impl->call(factorization); };
    if (cost().seconds < seconds_of_interrupt)
      work();
    else if (!ended_before_interrupt(*comm_, work))
      throw Interrupted();
    answer = impl_->answer();
    impl_->mumps.icntl[more_memory] *= 2;
  } while (std::count(std::begin(too_little_memory), std::end(too_little_memory), answer) > 0 &&
           impl_->mumps.icntl[more_memory] < 1000);
  impl_->mumps.icntl[more_memory] = first_more_memory;
  if (answer == out_of_memory) throw std::bad_alloc();
  if (answer != 0 && answer != singular && answer != not_definite_root && impl_->mumps.infog[num_negative] == 0)
    throw std::runtime_error("the sparse factor: MUMPS ends with " + std::to_string(answer));
  return impl_->exists = answer == 0 && impl_->mumps.infog[num_negative] == 0;
}

void MumpsFactor::solve(double *const x) const
{
  impl_->mumps.icntl[right_side] = dense;
  impl_->solve(x, 1);
}

/// MUMPS goes no further down its tree of unknowns than where columns have entries.
void MumpsFactor::solve(const SparseColumns &B, double *const x) const
{
  std::vector<int> begin(B.begin), row(B.row); // from 1
  std::vector<double> value(B.value);
  for (int &first : begin) ++first;
  for (int &r : row) ++r;
  auto &mumps = impl_->mumps;
  mumps.icntl[right_side] = sparse;
  if (comm_->getRank() == 0) { // entries on other ranks are refused
    mumps.nz_rhs = static_cast<MUMPS_INT>(row.size());
    mumps.irhs_ptr = begin.data();
    mumps.irhs_sparse = row.data();
    mumps.rhs_sparse = value.data();
  }
  impl_->solve(x, B.count());
}

} // namespace rpc::solver
