// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/algebra/repeated_rows.hpp"

#include "row_products.hpp"
#include "rpc/core/device_values.hpp"
#include "rpc/core/dofs.hpp"

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
        const row_products::NodeRows rows{one.rest.graph.row_map.data(), one.rest.graph.entries.data(),
                                          one.rest.values.data()};
        double *const y = &one.y(dof(Dim, node, 0));
        row_products::multiply_alone(row_products::Dimension<Dim>(), rows, -1 - k, end - node, one.x.data(), y);
        node = end;
        continue;
      }
      const LO begin = one.begin(k);
      const row_products::Stencil stencil{one.offset.data() + begin,
                                          one.value.data() + padded<Dim> * static_cast<std::size_t>(begin),
                                          one.begin(k + 1) - begin};
      const double *const x = one.x.data() + dof(Dim, static_cast<std::ptrdiff_t>(node), 0);
      double *const y = one.y.data() + dof(Dim, static_cast<std::ptrdiff_t>(node), 0);
      row_products::multiply_run(row_products::Dimension<Dim>(), stencil, end - node, x, y);
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
