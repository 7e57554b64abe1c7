#include "rpc/core/repeated_rows.hpp"

#include "rpc/core/device_values.hpp"
#include "rpc/core/dofs.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__CUDACC__)
#define RPC_HAS_VECTORS
#endif

namespace rpc
{
namespace
{

constexpr int most_kinds = 600;
constexpr std::size_t enough_kinds = 30;
constexpr double few_nodes = 0.05;
constexpr double least_part = 0.75; // of the nodes that repeat
constexpr short no_kind = -1;

constexpr bool on_gpu = !Kokkos::SpaceAccessibility<ExecutionSpace, HostSpace>::accessible;

using LocalMatrix = CrsMatrix::local_matrix_device_type;

/// A block of a row in the list of a kind: four numbers in the plane, column after column; in space three columns of four, the last
/// of which is 0.
template <int Dim>
constexpr int padded = Dim == 2 ? 4 : 12;
template <int Dim>
KOKKOS_INLINE_FUNCTION constexpr int place_in_block(const int row, const int column)
{
  return Dim == 2 ? 2 * column + row : 4 * column + row;
}

KOKKOS_INLINE_FUNCTION LO node_at(const LO place, const LO num_nodes)
{
  const LO rest = num_nodes - num_nodes / 2;
  return place < rest ? num_nodes / 2 + place : place - rest;
}

/// Gives `kind` to the nodes without one whose rows are those of the example.
struct TakeKind {
  LocalMatrix A;             // in
  int dim;                   //
  LO example;                // node
  short kind;                //
  DeviceView<short *> taken; // (owned nodes)  inout

  KOKKOS_FUNCTION bool same(const LO node) const
  {
    const LO shift = dof(dim, node - example, 0);
    for (int k = 0; k < dim; ++k) {
      const auto of_node = A.graph.row_map(dof(dim, node, k)), of_example = A.graph.row_map(dof(dim, example, k));
      const auto length = A.graph.row_map(dof(dim, node, k) + 1) - of_node;
      if (A.graph.row_map(dof(dim, example, k) + 1) - of_example != length) return false;
      if (k == 0)
        for (std::size_t e = 0; e < length; e += dim)
          if (A.graph.entries(of_node + e) - A.graph.entries(of_example + e) != shift) return false;
      for (std::size_t e = 0; e < length; ++e)
        if (A.values(of_node + e) != A.values(of_example + e)) return false;
    }
    return true;
  }
  /// @param place  of the node, counted from the middle of the numbers: inside the mesh, where most rows repeat
  /// @param took   += 1 if the node took it
  /// @param first  the first place that is left without
  KOKKOS_FUNCTION void operator()(const LO place, LO &took, LO &first) const
  {
    const LO node = node_at(place, static_cast<LO>(taken.extent(0)));
    if (taken(node) != no_kind) return;
    if (same(node)) {
      taken(node) = kind;
      ++took;
    } else if (place < first) {
      first = place;
    }
  }
};

/// Copies the rows of the kinds' examples.
template <int Dim>
struct ListKinds {
  LocalMatrix A;              // in
  DeviceView<LO *> example;   // (kinds)       in
  DeviceView<LO *> begin;     // (kinds + 1)   in
  DeviceView<LO *> offset;    // (neighbours)  out
  DeviceView<double *> value; // (neighbours * padded)  out

  KOKKOS_FUNCTION void operator()(const LO kind) const
  {
    const LO node = example(kind);
    for (LO n = begin(kind); n < begin(kind + 1); ++n) {
      const LO at = Dim * (n - begin(kind));
      offset(n) = node_of(Dim, A.graph.entries(A.graph.row_map(dof(Dim, node, 0)) + at)) - node;
      for (int i = 0; i < Dim; ++i)
        for (int j = 0; j < Dim; ++j)
          value(padded<Dim> * n + place_in_block<Dim>(i, j)) = A.values(A.graph.row_map(dof(Dim, node, i)) + at + j);
    }
  }
};

/// The rows of one node.
template <int Dim, class In, class Out>
struct MultiplyNode {
  LocalMatrix A;              //                        in
  DeviceView<short *> kind;   // (owned nodes)          in
  DeviceView<LO *> begin;     // (kinds + 1)            in
  DeviceView<LO *> offset;    // (neighbours)           in
  DeviceView<double *> value; // (neighbours * padded)  in
  In x;                       // (columns)              in
  Out y;                      // (rows)                 out

  KOKKOS_FUNCTION void operator()(const LO node) const
  {
    const int k = kind(node);
    double sum[Dim] = {};
    if (k >= 0) {
      for (LO n = begin(k); n < begin(k + 1); ++n) {
        const LO first = dof(Dim, node + offset(n), 0);
        for (int j = 0; j < Dim; ++j)
          for (int i = 0; i < Dim; ++i) sum[i] += value(padded<Dim> * n + place_in_block<Dim>(i, j)) * x(first + j);
      }
    } else {
      const auto first = A.graph.row_map(dof(Dim, node, 0)), length = A.graph.row_map(dof(Dim, node, 0) + 1) - first;
      for (std::size_t e = 0; e < length; e += Dim)
        for (int i = 0; i < Dim; ++i)
          for (int j = 0; j < Dim; ++j)
            sum[i] += A.values(first + i * length + e + j) * x(A.graph.entries(first + e) + j);
    }
    for (int i = 0; i < Dim; ++i) y(dof(Dim, node, i)) = sum[i];
  }
};

#ifdef RPC_HAS_VECTORS

using Four = double __attribute__((vector_size(32)));

/// Neighbours of one kind, for the loops below.
struct Stencil {
  const LO *offset;
  const double *value;
  LO size;
};

/// The rows of `Count` nodes of one kind that follow each other: they share what is read of the kind, and each has a sum for each
/// column of a block, so that no addition waits for another one.
template <int Count>
__attribute__((always_inline)) inline void multiply_some_3d(const Stencil &stencil, const double *const x,
                                                            double *const y)
{
  Four first[Count] = {}, second[Count] = {}, third[Count] = {};
  for (LO n = 0; n < stencil.size; ++n) {
    const double *const from = x + 3 * static_cast<std::ptrdiff_t>(stencil.offset[n]);
    const double *const value = stencil.value + padded<3> * static_cast<std::ptrdiff_t>(n);
    Four p, q, r; // columns of the block; an array of them would go through memory
    __builtin_memcpy(&p, value, sizeof(p));
    __builtin_memcpy(&q, value + 4, sizeof(q));
    __builtin_memcpy(&r, value + 8, sizeof(r));
    for (int c = 0; c < Count; ++c) {
      const double a = from[3 * c], b = from[3 * c + 1], d = from[3 * c + 2];
      first[c] += p * Four{a, a, a, a};
      second[c] += q * Four{b, b, b, b};
      third[c] += r * Four{d, d, d, d};
    }
  }
  for (int c = 0; c < Count; ++c) {
    const Four sum = first[c] + second[c] + third[c];
    for (int i = 0; i < 3; ++i) y[3 * c + i] = sum[i];
  }
}

/// The same in the plane, for `Pairs` pairs of nodes: a vector holds the unknowns of a pair. Entries off the blocks' diagonals have
/// sums of their own, in which the rows of a node are swapped.
template <int Pairs>
__attribute__((always_inline)) inline void multiply_pairs_2d(const Stencil &stencil, const double *const x,
                                                             double *const y)
{
  Four same[Pairs] = {}, swapped[Pairs] = {};
  for (LO n = 0; n < stencil.size; ++n) {
    const double *const from = x + 2 * static_cast<std::ptrdiff_t>(stencil.offset[n]);
    const double *const v = stencil.value + padded<2> * static_cast<std::ptrdiff_t>(n);
    const Four diagonal{v[0], v[3], v[0], v[3]}, off{v[1], v[2], v[1], v[2]};
    for (int c = 0; c < Pairs; ++c) {
      Four pair;
      __builtin_memcpy(&pair, from + 4 * c, sizeof(pair));
      same[c] += diagonal * pair;
      swapped[c] += off * pair;
    }
  }
  for (int c = 0; c < Pairs; ++c) {
    const Four other = swapped[c], sum = same[c] + Four{other[1], other[0], other[3], other[2]};
    __builtin_memcpy(y + 4 * c, &sum, sizeof(sum));
  }
}

/// The rows of one node in the plane.
__attribute__((always_inline)) inline void multiply_one_2d(const Stencil &stencil, const double *const x,
                                                           double *const y)
{
  Four sum = {};
  for (LO n = 0; n < stencil.size; ++n) {
    const double *const from = x + 2 * static_cast<std::ptrdiff_t>(stencil.offset[n]);
    Four block;
    __builtin_memcpy(&block, stencil.value + padded<2> * static_cast<std::ptrdiff_t>(n), sizeof(block));
    sum += block * Four{from[0], from[0], from[1], from[1]};
  }
  y[0] = sum[0] + sum[2];
  y[1] = sum[1] + sum[3];
}

// With the widest vectors that the processor has, of four numbers: eight at a time gain nothing in the plane, and a quarter in space
// where they do not slow down the processor.

/// @param count  of nodes   @param x, y  at the first of the nodes
__attribute__((target_clones("arch=x86-64-v3", "default"))) void multiply_run_2d(const Stencil &stencil, const LO count,
                                                                                 const double *x, double *y)
{
  constexpr int pairs = 4;
  LO done = 0;
  for (; done + 2 * pairs <= count; done += 2 * pairs, x += 4 * pairs, y += 4 * pairs)
    multiply_pairs_2d<pairs>(stencil, x, y);
  for (; done + 2 <= count; done += 2, x += 4, y += 4) multiply_pairs_2d<1>(stencil, x, y);
  if (done < count) multiply_one_2d(stencil, x, y);
}
__attribute__((target_clones("arch=x86-64-v3", "default"))) void multiply_run_3d(const Stencil &stencil, const LO count,
                                                                                 const double *x, double *y)
{
  constexpr int at_once = 4;
  LO done = 0;
  for (; done + at_once <= count; done += at_once, x += 3 * at_once, y += 3 * at_once)
    multiply_some_3d<at_once>(stencil, x, y);
  for (; done < count; ++done, x += 3, y += 3) multiply_some_3d<1>(stencil, x, y);
}

/// Rows as they lie in the matrix: those of a node follow each other and have the same columns, so that one of them tells all.
struct NodeRows {
  const LocalMatrix::row_map_type::non_const_value_type *begin; // (rows + 1)
  const LO *column;                                             // (entries)
  const double *value;                                          // (entries)
};

/// The rows of some nodes, each entry of a block with a sum of its own: no addition waits for another one.
/// @param x  (columns)   @param y  at the first of the nodes
template <int Dim>
__attribute__((always_inline)) inline void multiply_alone_inline(const NodeRows &rows, const LO first_node,
                                                                 const LO count, const double *const x, double *y)
{
  for (LO node = first_node; node < first_node + count; ++node, y += Dim) {
    const auto first = rows.begin[dof(Dim, node, 0)], length = rows.begin[dof(Dim, node, 0) + 1] - first;
    const double *const value = rows.value + first;
    const LO *const column = rows.column + first;
    double sum[Dim][Dim] = {};
    for (std::size_t e = 0; e < length; e += Dim) {
      const double *const from = x + column[e];
      for (int i = 0; i < Dim; ++i)
        for (int j = 0; j < Dim; ++j) sum[i][j] += value[i * length + e + j] * from[j];
    }
    for (int i = 0; i < Dim; ++i) {
      double all = sum[i][0];
      for (int j = 1; j < Dim; ++j) all += sum[i][j];
      y[i] = all;
    }
  }
}
__attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default"))) void
multiply_alone_2d(const NodeRows &rows, const LO first_node, const LO count, const double *const x, double *const y)
{
  multiply_alone_inline<2>(rows, first_node, count, x, y);
}
__attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default"))) void
multiply_alone_3d(const NodeRows &rows, const LO first_node, const LO count, const double *const x, double *const y)
{
  multiply_alone_inline<3>(rows, first_node, count, x, y);
}

/// The rows of some nodes that follow each other.
template <int Dim, class In, class Out>
struct MultiplyNodes {
  static constexpr LO nodes_at_once = 512;

  MultiplyNode<Dim, In, Out> one;
  LO num_nodes;

  void operator()(const LO chunk) const
  {
    const LO last = std::min((chunk + 1) * nodes_at_once, num_nodes);
    LO node = chunk * nodes_at_once;
    while (node < last) {
      const short k = one.kind(node);
      LO end = node + 1;
      while (end < last && one.kind(end) == k) ++end;
      if (k < 0) {
        const NodeRows rows{one.A.graph.row_map.data(), one.A.graph.entries.data(), one.A.values.data()};
        if constexpr (Dim == 2)
          multiply_alone_2d(rows, node, end - node, one.x.data(), &one.y(dof(Dim, node, 0)));
        else
          multiply_alone_3d(rows, node, end - node, one.x.data(), &one.y(dof(Dim, node, 0)));
        node = end;
        continue;
      }
      const LO begin = one.begin(k);
      const Stencil stencil{one.offset.data() + begin, one.value.data() + padded<Dim> * static_cast<std::size_t>(begin),
                            one.begin(k + 1) - begin};
      const double *const x = one.x.data() + dof(Dim, static_cast<std::ptrdiff_t>(node), 0);
      double *const y = one.y.data() + dof(Dim, static_cast<std::ptrdiff_t>(node), 0);
      if constexpr (Dim == 2)
        multiply_run_2d(stencil, end - node, x, y);
      else
        multiply_run_3d(stencil, end - node, x, y);
      node = end;
    }
  }
};

#endif

template <int Dim, class In, class Out>
void multiply(const MultiplyNode<Dim, In, Out> &one)
{
  const LO num_nodes = static_cast<LO>(one.kind.extent(0));
#ifdef RPC_HAS_VECTORS
  using Nodes = MultiplyNodes<Dim, In, Out>;
  const LO chunks = (num_nodes + Nodes::nodes_at_once - 1) / Nodes::nodes_at_once;
  Kokkos::parallel_for("rpc::repeated_rows::multiply", device_range(chunks), Nodes{one, num_nodes});
#else
  Kokkos::parallel_for("rpc::repeated_rows::multiply", device_range(num_nodes), one);
#endif
  Kokkos::fence();
}

} // namespace

std::optional<RepeatedRows> RepeatedRows::of(RCP<const CrsMatrix> A, const int dim)
{
  const LocalMatrix matrix = A->getLocalMatrixDevice();
  const LO num_nodes = node_of(dim, matrix.numRows());
  if (num_nodes == 0 || dim < 2) return std::nullopt;
  const DeviceView<short *> kind(Kokkos::ViewAllocateWithoutInitializing("rpc::repeated_rows::kind"), num_nodes);
  Kokkos::deep_copy(kind, no_kind);
  std::vector<LO> examples;
  LO next = 0, repeated = 0; // the first place without a kind
  bool has_kinds = true;
  while (next < num_nodes && static_cast<int>(examples.size()) < most_kinds) {
    const LO place = next;
    const TakeKind take{matrix, dim, node_at(place, num_nodes), static_cast<short>(examples.size()), kind};
    LO took = 0;
    Kokkos::parallel_reduce("rpc::repeated_rows::take_kind", device_range(num_nodes), take, Kokkos::Sum<LO>(took),
                            Kokkos::Min<LO>(next));
    has_kinds = took > 0; // else there are values that are not numbers
    if (!has_kinds) break;
    repeated += took - 1; // all but the example
    examples.push_back(take.example);
    // Few rows of many kinds promise a mesh without order, and each kind costs a pass over the nodes.
    has_kinds = examples.size() < enough_kinds || repeated >= few_nodes * num_nodes;
    if (!has_kinds) break;
  }
  if (!has_kinds || repeated < least_part * num_nodes) {
    if (on_gpu) return std::nullopt; // where a thread for each node would read entries far apart
    examples.clear();
    Kokkos::deep_copy(kind, no_kind);
  }
  const auto row_map = to_host(matrix.graph.row_map);
  std::vector<LO> begin{0};
  for (const LO node : examples)
    begin.push_back(begin.back() + static_cast<LO>(row_map(dof(dim, node, 0) + 1) - row_map(dof(dim, node, 0))) / dim);
  RepeatedRows result;
  result.A_ = std::move(A);
  result.dim_ = dim;
  result.kind_ = kind;
  result.begin_ = device_values(begin, "rpc::repeated_rows::begin");
  result.offset_ = DeviceView<LO *>("rpc::repeated_rows::offset", begin.back());
  const auto example = device_values(examples, "rpc::repeated_rows::example");
  const auto kinds = device_range(static_cast<LO>(examples.size()));
  if (dim == 2) {
    result.value_ = DeviceView<double *>("rpc::repeated_rows::value", std::size_t(padded<2>) * begin.back());
    Kokkos::parallel_for("rpc::repeated_rows::list", kinds,
                         ListKinds<2>{matrix, example, result.begin_, result.offset_, result.value_});
  } else {
    result.value_ = DeviceView<double *>("rpc::repeated_rows::value", std::size_t(padded<3>) * begin.back());
    Kokkos::parallel_for("rpc::repeated_rows::list", kinds,
                         ListKinds<3>{matrix, example, result.begin_, result.offset_, result.value_});
  }
  Kokkos::fence();
  return result;
}

void RepeatedRows::apply(const Vector &x, Vector &y) const
{
  const auto from = device_read(x);
  const auto to = device_write(y);
  const auto matrix = A_->getLocalMatrixDevice();
  using In = std::decay_t<decltype(from)>;
  using Out = std::decay_t<decltype(to)>;
  if (dim_ == 2)
    multiply(MultiplyNode<2, In, Out>{matrix, kind_, begin_, offset_, value_, from, to});
  else
    multiply(MultiplyNode<3, In, Out>{matrix, kind_, begin_, offset_, value_, from, to});
}

} // namespace rpc
