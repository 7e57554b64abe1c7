#include "rpc/algebra/repeated_rows.hpp"

#include "rpc/core/device_values.hpp"
#include "rpc/core/dofs.hpp"
#include "rpc/core/vectors.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace rpc
{
namespace
{

using LocalMatrix = RepeatedRows::LocalMatrix;

template <int Dim>
constexpr std::size_t padded = RepeatedRows::block_size(Dim);

/// Whether two nodes have the same rows, but for a shift of the columns' numbers.
struct SameRows {
  LocalMatrix A; // in
  int dim;       //

  KOKKOS_FUNCTION bool operator()(const LO node, const LO other) const
  {
    const LO shift = dof(dim, node - other, 0);
    for (int k = 0; k < dim; ++k) {
      const auto of_node = A.graph.row_map(dof(dim, node, k)), of_other = A.graph.row_map(dof(dim, other, k));
      const auto length = A.graph.row_map(dof(dim, node, k) + 1) - of_node;
      if (A.graph.row_map(dof(dim, other, k) + 1) - of_other != length) return false;
      if (k == 0)
        for (std::size_t e = 0; e < length; e += dim)
          if (A.graph.entries(of_node + e) - A.graph.entries(of_other + e) != shift) return false;
      for (std::size_t e = 0; e < length; ++e)
        if (A.values(of_node + e) != A.values(of_other + e)) return false;
    }
    return true;
  }
};

/// Lists the rows of the kinds' examples.
struct ListKinds {
  int dim;
  RowsOfNodes examples;       // (kinds)       in
  DeviceView<LO *> begin;     // (kinds + 1)   in
  DeviceView<LO *> offset;    // (neighbours)  out
  DeviceView<double *> value; // (neighbours * size of a block)  out

  KOKKOS_FUNCTION void operator()(const LO kind) const
  {
    const auto &A = examples.rows;
    const LO node = examples.node(kind), place = examples.place(kind);
    for (LO n = begin(kind); n < begin(kind + 1); ++n) {
      const LO at = dim * (n - begin(kind));
      offset(n) = node_of(dim, A.graph.entries(A.graph.row_map(dof(dim, place, 0)) + at)) - node;
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
          value(RepeatedRows::block_size(dim) * n + RepeatedRows::place_in_block(dim, i, j)) =
              A.values(A.graph.row_map(dof(dim, place, i)) + at + j);
    }
  }
};

/// The rows of one node.
template <int Dim, class In, class Out>
struct MultiplyNode {
  LocalMatrix rest;           //                        in
  DeviceView<int *> kind;     // (owned nodes)          in
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
          for (int i = 0; i < Dim; ++i)
            sum[i] += value(padded<Dim> * n + RepeatedRows::place_in_block(Dim, i, j)) * x(first + j);
      }
    } else {
      const LO row = dof(Dim, -1 - k, 0);
      const auto first = rest.graph.row_map(row), length = rest.graph.row_map(row + 1) - first;
      for (std::size_t e = 0; e < length; e += Dim)
        for (int i = 0; i < Dim; ++i)
          for (int j = 0; j < Dim; ++j)
            sum[i] += rest.values(first + i * length + e + j) * x(rest.graph.entries(first + e) + j);
    }
    for (int i = 0; i < Dim; ++i) y(dof(Dim, node, i)) = sum[i];
  }
};

#ifdef RPC_HAS_VECTORS

/// Neighbours of one kind, for the loops below.
struct Stencil {
  const LO *offset;
  const double *value;
  LO size;
};

/// The rows of `Count` nodes of one kind that follow each other: they share the loads of the kind's blocks, and each has a sum for each
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

/// The rows of `Vectors` vectors of nodes with one unknown each.
template <int Vectors>
__attribute__((always_inline)) inline void multiply_some_1d(const Stencil &stencil, const double *const x,
                                                            double *const y)
{
  Four sum[Vectors] = {};
  for (LO n = 0; n < stencil.size; ++n) {
    const double *const from = x + stencil.offset[n];
    const double value = stencil.value[n];
    for (int v = 0; v < Vectors; ++v) {
      Four next;
      __builtin_memcpy(&next, from + 4 * v, sizeof(next));
      sum[v] += Four{value, value, value, value} * next;
    }
  }
  for (int v = 0; v < Vectors; ++v) __builtin_memcpy(y + 4 * v, &sum[v], sizeof(Four));
}

// With the widest vectors that the processor has, of four numbers: eight at a time gain nothing in the plane, and a quarter in space
// where they do not slow down the processor.

/// @param count  of nodes   @param x, y  at the first of the nodes
__attribute__((target_clones("arch=x86-64-v3", "default"))) void multiply_run_1d(const Stencil &stencil, const LO count,
                                                                                 const double *x, double *y)
{
  constexpr int vectors = 4;
  LO done = 0;
  for (; done + 4 * vectors <= count; done += 4 * vectors, x += 4 * vectors, y += 4 * vectors)
    multiply_some_1d<vectors>(stencil, x, y);
  for (; done + 4 <= count; done += 4, x += 4, y += 4) multiply_some_1d<1>(stencil, x, y);
  for (; done < count; ++done, ++x, ++y) {
    double sum = 0;
    for (LO n = 0; n < stencil.size; ++n) sum += stencil.value[n] * x[stencil.offset[n]];
    *y = sum;
  }
}
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

/// Rows as they lie in the matrix: those of a node follow each other and have the same columns, read from the first row.
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
multiply_alone_1d(const NodeRows &rows, const LO first_node, const LO count, const double *const x, double *const y)
{
  multiply_alone_inline<1>(rows, first_node, count, x, y);
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
      const int k = one.kind(node);
      LO end = node + 1;
      while (end < last && one.kind(end) == (k < 0 ? one.kind(end - 1) - 1 : k)) ++end;
      if (k < 0) {
        const NodeRows rows{one.rest.graph.row_map.data(), one.rest.graph.entries.data(), one.rest.values.data()};
        double *const y = &one.y(dof(Dim, node, 0));
        if constexpr (Dim == 1)
          multiply_alone_1d(rows, -1 - k, end - node, one.x.data(), y);
        else if constexpr (Dim == 2)
          multiply_alone_2d(rows, -1 - k, end - node, one.x.data(), y);
        else
          multiply_alone_3d(rows, -1 - k, end - node, one.x.data(), y);
        node = end;
        continue;
      }
      const LO begin = one.begin(k);
      const Stencil stencil{one.offset.data() + begin, one.value.data() + padded<Dim> * static_cast<std::size_t>(begin),
                            one.begin(k + 1) - begin};
      const double *const x = one.x.data() + dof(Dim, static_cast<std::ptrdiff_t>(node), 0);
      double *const y = one.y.data() + dof(Dim, static_cast<std::ptrdiff_t>(node), 0);
      if constexpr (Dim == 1)
        multiply_run_1d(stencil, end - node, x, y);
      else if constexpr (Dim == 2)
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
}

/// Nodes of no kind find their rows in a matrix of all nodes.
void number_the_rest(const DeviceView<int *> &kind)
{
  Kokkos::parallel_for(
      "rpc::repeated_rows::number_the_rest", device_range(static_cast<LO>(kind.extent(0))),
      KOKKOS_LAMBDA(const LO node) {
        if (kind(node) < 0) kind(node) = -1 - node;
      });
  Kokkos::fence();
}

/// Or in one of some nodes.
/// @param first  of those of no kind
void number_the_rest(const DeviceView<int *> &kind, const RowsOfNodes &rows, const LO first)
{
  Kokkos::parallel_for(
      "rpc::repeated_rows::number_the_rest", Kokkos::RangePolicy<ExecutionSpace, LO>(first, rows.size()),
      KOKKOS_LAMBDA(const LO i) { kind(rows.node(i)) = -1 - rows.place(i); });
  Kokkos::fence();
}

/// (kinds + 1) Where the neighbours of each example begin in a list.
DeviceView<LO *> neighbours_begin(const RowsOfNodes &examples, const int dim)
{
  const DeviceView<LO *> begin("rpc::repeated_rows::begin", examples.size() + 1);
  const auto row_map = examples.rows.graph.row_map;
  const auto place = examples.place;
  Kokkos::parallel_scan(
      "rpc::repeated_rows::begin", device_range(examples.size()), KOKKOS_LAMBDA(const LO k, LO &sum, const bool last) {
        const LO row = dof(dim, place(k), 0);
        sum += static_cast<LO>(row_map(row + 1) - row_map(row)) / dim;
        if (last) begin(k + 1) = sum;
      });
  Kokkos::fence();
  return begin;
}

} // namespace

RepeatedRows RepeatedRows::of(RCP<const CrsMatrix> A, const int dim)
{
  const LocalMatrix matrix = A->getLocalMatrixDevice();
  const LO num_nodes = node_of(dim, matrix.numRows());
  RepeatedRows result;
  result.dim_ = dim;
  result.A_ = std::move(A);
  const auto kinds = alike_nodes_of(num_nodes, SameRows{matrix, dim});
  if (kinds) {
    result.kind_ = kinds->kind;
  } else {
    result.kind_ = DeviceView<int *>(Kokkos::ViewAllocateWithoutInitializing("rpc::repeated_rows::kind"), num_nodes);
    Kokkos::deep_copy(result.kind_, -1);
  }
  number_the_rest(result.kind_);
  const auto example = device_values(kinds ? kinds->example : std::vector<LO>{}, "rpc::repeated_rows::example");
  result.list_kinds({example, example, matrix});
  result.pays_ = (!on_gpu && dim > 1) || min_all(*result.A_->getComm(), result.any_repeat() ? 1 : 0) == 1;
  return result;
}

RepeatedRows RepeatedRows::of(const AlikeNodes &kinds, const RowsOfNodes &rows, const int dim)
{
  RepeatedRows result;
  result.dim_ = dim;
  result.rest_ = rows.rows;
  result.kind_ = kinds.kind;
  const LO num_kinds = static_cast<LO>(kinds.example.size());
  number_the_rest(result.kind_, rows, num_kinds);
  const std::pair<LO, LO> examples(0, num_kinds);
  result.list_kinds({Kokkos::subview(rows.node, examples), Kokkos::subview(rows.place, examples), rows.rows});
  return result;
}

void RepeatedRows::list_kinds(const RowsOfNodes &examples)
{
  begin_ = neighbours_begin(examples, dim_);
  LO num_neighbours = 0;
  Kokkos::deep_copy(num_neighbours, Kokkos::subview(begin_, examples.size()));
  offset_ = DeviceView<LO *>("rpc::repeated_rows::offset", num_neighbours);
  value_ = DeviceView<double *>("rpc::repeated_rows::value", block_size(dim_) * num_neighbours);
  Kokkos::parallel_for("rpc::repeated_rows::list", device_range(examples.size()),
                       ListKinds{dim_, examples, begin_, offset_, value_});
  Kokkos::fence();
}

RepeatedRows::Blocks RepeatedRows::blocks() const
{
  return {dim_, kind_, begin_, offset_, value_, rest()};
}

NodeBlocks diagonal_blocks(const RepeatedRows &rows)
{
  const int dim = rows.dim(), num_kinds = rows.num_kinds();
  const LO num_nodes = rows.num_nodes();
  const auto from = rows.blocks();
  NodeBlocks blocks;
  LO num_blocks = num_nodes;
  if (num_kinds > 0) { // those of the kinds, then those of nodes of no kind
    blocks.place = DeviceView<LO *>("rpc::repeated_rows::place_of_block", num_nodes);
    const auto place = blocks.place;
    LO others = 0;
    Kokkos::parallel_scan(
        "rpc::repeated_rows::place_blocks", device_range(num_nodes),
        KOKKOS_LAMBDA(const LO node, LO &next, const bool last) {
          const int kind = from.kind(node);
          if (last) place(node) = kind >= 0 ? kind : num_kinds + next;
          next += kind < 0;
        },
        others);
    num_blocks = num_kinds + others;
  }
  blocks.block = DeviceView<double ***>(Kokkos::ViewAllocateWithoutInitializing("rpc::repeated_rows::diagonal_blocks"),
                                        num_blocks, dim, dim);
  const auto to = blocks;
  Kokkos::parallel_for(
      "rpc::repeated_rows::read_blocks_of_kinds", device_range(std::max(num_kinds, 0)), KOKKOS_LAMBDA(const LO kind) {
        LO own = from.begin(kind);
        while (from.offset(own) != 0) ++own;
        for (int i = 0; i < dim; ++i)
          for (int j = 0; j < dim; ++j)
            to.block(kind, i, j) =
                from.value(RepeatedRows::block_size(dim) * own + RepeatedRows::place_in_block(dim, i, j));
      });
  Kokkos::parallel_for(
      "rpc::repeated_rows::read_other_blocks", device_range(num_nodes), KOKKOS_LAMBDA(const LO node) {
        if (from.kind(node) >= 0) return;
        const LO own = from.own(node), place = to.of(node);
        for (int i = 0; i < dim; ++i)
          for (int j = 0; j < dim; ++j) to.block(place, i, j) = from.entry(node, own, i, j);
      });
  Kokkos::fence();
  return blocks;
}

void RepeatedRows::apply(const Vector &x, Vector &y) const
{
  const auto from = device_read(x);
  const auto to = device_write(y);
  using In = std::decay_t<decltype(from)>;
  using Out = std::decay_t<decltype(to)>;
  if (dim_ == 1)
    multiply(MultiplyNode<1, In, Out>{rest(), kind_, begin_, offset_, value_, from, to});
  else if (dim_ == 2)
    multiply(MultiplyNode<2, In, Out>{rest(), kind_, begin_, offset_, value_, from, to});
  else
    multiply(MultiplyNode<3, In, Out>{rest(), kind_, begin_, offset_, value_, from, to});
}

} // namespace rpc
