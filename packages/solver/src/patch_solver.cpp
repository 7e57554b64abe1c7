// SPDX-License-Identifier: BSD-3-Clause
#include "patch_solver.hpp"

#include "rpc/core/device_values.hpp"
#include "rpc/core/dofs.hpp"
#include "rpc/core/fingerprint.hpp"
#include "rpc/core/vectors.hpp"

#include <Teuchos_LAPACK.hpp>
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <numeric>
#include <stdexcept>
#include <unordered_map>
#include <utility>

namespace rpc::solver
{
namespace
{

constexpr const char *patch_not_definite = "multigrid: the matrix of a patch of nodes is not positive definite";

/// Distance of the columns of an inverse: whole vectors.
KOKKOS_INLINE_FUNCTION constexpr std::size_t stride_of(const std::size_t rows)
{
  return (rows + 3) / 4 * 4;
}

std::uint64_t fingerprint(const std::vector<double> &values)
{
  std::uint64_t print = values.size();
  for (const double value : values) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof(bits));
    print = scrambled(print, bits);
  }
  return print;
}

/// Appends the inverse of a symmetric positive definite matrix. @return whether it is one
bool append_inverse(std::vector<double> matrix, const int rows, std::vector<double> &to)
{
  Teuchos::LAPACK<int, double> lapack;
  int info = 0;
  lapack.POTRF('U', rows, matrix.data(), rows, &info);
  if (info == 0) lapack.POTRI('U', rows, matrix.data(), rows, &info);
  const std::size_t n = rows, stride = stride_of(n), first = to.size();
  to.resize(first + stride * n);
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i <= j; ++i) to[first + stride * j + i] = to[first + stride * i + j] = matrix[n * j + i];
  return info == 0;
}

/// part <- (R_p A R_p^T)^-1 R_p r at one node of a patch.
template <int Dim, class In>
struct SolveOnPatch {
  DeviceView<LO *> begin, node, patch; //                        in, as of PatchSolver
  DeviceView<std::size_t *> place;     //                        in
  DeviceView<double *> inverse;        //                        in
  In r;                                // (nodes * Dim)          in
  DeviceView<double *> part;           // (entries * Dim)        out

  KOKKOS_FUNCTION void operator()(const LO e) const
  {
    const LO p = patch(e), first = begin(p), size = begin(p + 1) - first;
    const std::size_t stride = stride_of(static_cast<std::size_t>(Dim) * size);
    double sum[Dim] = {};
    for (LO n = 0; n < size; ++n)
      for (int l = 0; l < Dim; ++l) {
        const double x = r(dof(Dim, node(first + n), l));
        const std::size_t column = place(p) + stride * dof(Dim, n, l) + Dim * (e - first);
        for (int k = 0; k < Dim; ++k) sum[k] += inverse(column + k) * x;
      }
    for (int k = 0; k < Dim; ++k) part(dof(Dim, e, k)) = sum[k];
  }
};

#ifdef RPC_HAS_VECTORS

/// Rows of `Vectors` vectors of the solutions on `Count` patches that share an inverse: they share its loads.
/// @param x  (columns, Count)   @param y  (Count) where these rows begin
template <int Count, int Vectors>
__attribute__((always_inline)) inline void solve_rows(const double *inverse, const std::size_t stride,
                                                      const int columns, const double *x, double *const (&y)[Count])
{
  Four sum[Count][Vectors] = {};
  for (int j = 0; j < columns; ++j, inverse += stride, x += Count) {
    Four column[Vectors];
    for (int v = 0; v < Vectors; ++v) __builtin_memcpy(&column[v], inverse + 4 * v, sizeof(Four));
    for (int c = 0; c < Count; ++c)
      for (int v = 0; v < Vectors; ++v) sum[c][v] += column[v] * Four{x[c], x[c], x[c], x[c]};
  }
  for (int c = 0; c < Count; ++c)
    for (int v = 0; v < Vectors; ++v) __builtin_memcpy(y[c] + 4 * v, &sum[c][v], sizeof(Four));
}

/// All rows, so many vectors at a time.
template <int Count, int Vectors>
__attribute__((always_inline)) inline void solve_all_rows(const double *const inverse, const int rows,
                                                          const double *const x, double *const (&y)[Count])
{
  const std::size_t stride = stride_of(rows);
  std::size_t row = 0;
  const auto at_row = [&](double *(&to)[Count]) {
    for (int c = 0; c < Count; ++c) to[c] = y[c] + row;
  };
  double *to[Count];
  for (; row + 4 * Vectors <= stride; row += 4 * Vectors) {
    at_row(to);
    solve_rows<Count, Vectors>(inverse + row, stride, rows, x, to);
  }
  for (; row < stride; row += 4) {
    at_row(to);
    solve_rows<Count, 1>(inverse + row, stride, rows, x, to);
  }
}
__attribute__((target_clones("arch=x86-64-v3", "default"))) void solve_one(const double *const inverse, const int rows,
                                                                           const double *const x, double *const (&y)[1])
{
  solve_all_rows<1, 7>(inverse, rows, x, y);
}
__attribute__((target_clones("arch=x86-64-v3", "default"))) void
solve_four(const double *const inverse, const int rows, const double *const x, double *const (&y)[4])
{
  solve_all_rows<4, 3>(inverse, rows, x, y);
}

/// The same on patches that follow each other.
template <int Dim, class In>
struct SolveOnPatches {
  static constexpr int patches_at_once = 64;

  SolveOnPatch<Dim, In> one;
  LO num_patches;

  template <int Count>
  void solve(const LO p, std::vector<double> &x, std::vector<double> &solution) const
  {
    const LO size = one.begin(p + 1) - one.begin(p), rows = Dim * size;
    const std::size_t stride = stride_of(rows);
    x.resize(static_cast<std::size_t>(Count) * rows);
    solution.resize(Count * stride);
    double *y[Count];
    for (int c = 0; c < Count; ++c) {
      y[c] = solution.data() + c * stride;
      for (LO n = 0; n < size; ++n)
        for (int k = 0; k < Dim; ++k)
          x[static_cast<std::size_t>(Count) * dof(Dim, n, k) + c] = one.r(dof(Dim, one.node(one.begin(p + c) + n), k));
    }
    const double *const inverse = &one.inverse(one.place(p));
    if constexpr (Count == 4)
      solve_four(inverse, rows, x.data(), y);
    else
      solve_one(inverse, rows, x.data(), y);
    for (int c = 0; c < Count; ++c) std::copy_n(y[c], rows, &one.part(dof(Dim, one.begin(p + c), 0)));
  }
  void operator()(const LO chunk) const
  {
    std::vector<double> x, y;
    const LO last = std::min((chunk + 1) * patches_at_once, num_patches);
    for (LO p = chunk * patches_at_once; p < last;) {
      const auto shares = [&](const LO q) { return q < last && one.place(q) == one.place(p); };
      const bool four = shares(p + 1) && shares(p + 2) && shares(p + 3);
      if (four)
        solve<4>(p, x, y);
      else
        solve<1>(p, x, y);
      p += four ? 4 : 1;
    }
  }
};

#endif

/// z <- the sum of the parts of each node.
template <int Dim, class Out>
struct AddParts {
  DeviceView<LO *> first, entry; // (nodes + 1), (entries)   in
  DeviceView<double *> part;     // (entries * Dim)          in
  Out z;                         // (nodes * Dim)            out

  KOKKOS_FUNCTION void operator()(const LO node) const
  {
    double sum[Dim] = {};
    for (LO e = first(node); e < first(node + 1); ++e)
      for (int k = 0; k < Dim; ++k) sum[k] += part(dof(Dim, entry(e), k));
    for (int k = 0; k < Dim; ++k) z(dof(Dim, node, k)) = sum[k];
  }
};

} // namespace

PatchSolver::PatchSolver(const RepeatedRows &rows, const RCP<const Map> &nodes, const std::vector<GO> &columns,
                         const NodePatches &patches, const AddedBlocks &added)
    : matrices_(rows, nodes, columns, patches, added), dim_(rows.dim()), comm_(nodes->getComm()),
      halo_(std::make_shared<const Halo>(Halo(nodes, matrices_.ghosts()), dim_))
{
  invert_what_stays();
  list_entries();
  invert_what_changes();
}

/// Inverses of the patches that contact does not add to, and room for the others.
void PatchSolver::invert_what_stays()
{
  std::map<std::vector<LO>, int> patch_like;
  std::unordered_multimap<std::uint64_t, int> patches_with; // by their matrices' fingerprints
  std::vector<std::size_t> place(matrices_.size());
  std::vector<double> inverses;
  bool good = true;
  const auto make = [&](const int p) {
    auto matrix = matrices_.without_contact(p);
    const std::uint64_t print = fingerprint(matrix);
    const auto [first, last] = patches_with.equal_range(print);
    const auto equal =
        std::find_if(first, last, [&](const auto &other) { return matrices_.without_contact(other.second) == matrix; });
    if (equal != last) return place[equal->second];
    const std::size_t end = inverses.size();
    good = append_inverse(std::move(matrix), matrices_.rows_of(p), inverses) && good;
    ++num_inverses_;
    patches_with.emplace(print, p);
    return end;
  };
  for (int p = 0; p < matrices_.size(); ++p) {
    if (matrices_.changes(p)) {
      changing_.push_back(p);
      without_.push_back(matrices_.without_contact(p));
      continue;
    }
    const auto likeness = matrices_.likeness(p);
    const auto like = likeness.empty() ? patch_like.end() : patch_like.find(likeness);
    place[p] = like == patch_like.end() ? make(p) : place[like->second];
    if (!likeness.empty()) patch_like.emplace(likeness, p);
  }
  matrices_.forget_rows();
  first_changing_ = inverses.size();
  for (const int p : changing_) {
    const std::size_t size = matrices_.rows_of(p);
    place[p] = inverses.size();
    place_of_changing_.push_back(inverses.size() - first_changing_);
    inverses.resize(inverses.size() + size * stride_of(size));
  }
  num_inverses_ += static_cast<int>(changing_.size());
  last_added_.resize(changing_.size());
  changing_inverse_ = HostView<double *>("rpc::solver::changing_inverses", inverses.size() - first_changing_);
  if (min_all(*comm_, good ? 1 : 0) == 0) throw std::runtime_error(patch_not_definite);
  place_ = device_values(place, "rpc::solver::place_of_inverse");
  inverse_ = device_values(inverses, "rpc::solver::patch_inverses");
}

/// The nodes of patches, and the patches of nodes.
void PatchSolver::list_entries()
{
  const auto &begin = matrices_.begin(), &node = matrices_.node();
  std::vector<LO> patch(node.size()), first_entry(matrices_.num_nodes() + 1), entry(node.size());
  for (int p = 0; p < matrices_.size(); ++p) std::fill(patch.begin() + begin[p], patch.begin() + begin[p + 1], p);
  for (const LO n : node) ++first_entry[n + 1];
  std::partial_sum(first_entry.begin(), first_entry.end(), first_entry.begin());
  std::vector<LO> next(first_entry.begin(), first_entry.end() - 1);
  for (std::size_t e = 0; e < node.size(); ++e) entry[next[node[e]]++] = static_cast<LO>(e);
  begin_ = device_values(begin, "rpc::solver::patch_begin");
  node_ = device_values(node, "rpc::solver::patch_nodes");
  patch_ = device_values(patch, "rpc::solver::patch_of_entry");
  first_entry_ = device_values(first_entry, "rpc::solver::first_entry");
  entry_ = device_values(entry, "rpc::solver::entries_of_nodes");
  part_ = DeviceView<double *>("rpc::solver::patch_parts", dim_ * node.size());
}

void PatchSolver::set_added(const DeviceView<double ***> &block)
{
  matrices_.set_added(block);
  invert_what_changes();
}

/// Inverses of the patches to which contact adds something else than last time.
void PatchSolver::invert_what_changes()
{
  bool good = true, changed = false;
  std::vector<double> inverse;
  for (std::size_t c = 0; c < changing_.size(); ++c) {
    auto matrix = matrices_.added(changing_[c]);
    if (matrix == last_added_[c]) continue;
    last_added_[c] = matrix;
    changed = true;
    for (std::size_t e = 0; e < matrix.size(); ++e) matrix[e] += without_[c][e];
    inverse.clear();
    good = append_inverse(std::move(matrix), matrices_.rows_of(changing_[c]), inverse) && good;
    std::copy(inverse.begin(), inverse.end(), changing_inverse_.data() + place_of_changing_[c]);
  }
  if (min_all(*comm_, good ? 1 : 0) == 0) {
    for (auto &last : last_added_) last.clear(); // all are made anew next
    throw std::runtime_error(patch_not_definite);
  }
  if (!changed) return;
  const std::pair<std::size_t, std::size_t> all(first_changing_, inverse_.extent(0));
  Kokkos::deep_copy(Kokkos::subview(inverse_, all), changing_inverse_);
}

void PatchSolver::apply(const Vector &r, Vector &z) const
{
  const auto from = device_read(halo_->at_columns(r));
  using In = std::decay_t<decltype(from)>;
  const auto apply_in = [&](const auto dim) {
    const SolveOnPatch<decltype(dim)::value, In> solve{begin_, node_, patch_, place_, inverse_, from, part_};
#ifdef RPC_HAS_VECTORS
    using Patches = SolveOnPatches<decltype(dim)::value, In>;
    const LO chunks = (num_patches() + Patches::patches_at_once - 1) / Patches::patches_at_once;
    Kokkos::parallel_for("rpc::solver::solve_on_patches", device_range(chunks), Patches{solve, num_patches()});
#else
    Kokkos::parallel_for("rpc::solver::solve_on_patches", device_range(static_cast<LO>(node_.extent(0))), solve);
#endif
    const auto to = device_write(halo_->is_empty() ? z : halo_->columns());
    Kokkos::parallel_for("rpc::solver::add_parts", device_range(static_cast<LO>(first_entry_.extent(0)) - 1),
                         AddParts<decltype(dim)::value, std::decay_t<decltype(to)>>{first_entry_, entry_, part_, to});
  };
  if (dim_ == 2)
    apply_in(std::integral_constant<int, 2>());
  else
    apply_in(std::integral_constant<int, 3>());
  if (!halo_->is_empty()) halo_->sum_at_owners(z);
}

} // namespace rpc::solver
