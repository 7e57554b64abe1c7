// SPDX-License-Identifier: BSD-3-Clause
/// Times of the kernels that a solve consists of, those of multigrid's cycle among them, beside the memory bandwidth that a STREAM
/// triad reaches in the same run.
///
///     kernels [--cells=256,512] [--cells-in-space=16,32] [Google Benchmark's options]
///     mpirun -n 2 kernels    # the triad alone, on all ranks at once
///
/// Each kernel reports the bytes that it must move at least (every array once), for products and what consists of them the floating
/// point operations, the least time per item (cell or row), the rates that follow, and the bandwidth's fraction of the triad's. Q2 and P2 take half the cells in each direction: as many nodes. In
/// space the elements' names end in 3D.

#include "multigrid/node_interpolation.hpp"
#include "multigrid/node_smoother.hpp"
#include "rpc/algebra/stiffness_operator.hpp"
#include "rpc/fem/elasticity.hpp"
#include "rpc/fem/interpolation.hpp"
#include "rpc/fem/order_one.hpp"
#include "rpc/mesh/box.hpp"

#include <Kokkos_Timer.hpp>
#include <Tpetra_Core.hpp>
#include <algorithm>
#include <benchmark/benchmark.h>
#include <limits>
#include <malloc.h>
#include <sstream>

namespace
{

using namespace rpc;

/// GB/s of a[i] = b[i] + s c[i] over all ranks, 24 bytes an entry as STREAM counts; the best of some repetitions.
double triad(const Comm &comm)
{
  constexpr LO entries = 1 << 25; // 256 MiB an array, beyond every cache
  constexpr int repetitions = 10;
  const DeviceView<double *> a("rpc::benchmark::a", entries), b("rpc::benchmark::b", entries),
      c("rpc::benchmark::c", entries);
  Kokkos::deep_copy(b, 1.);
  Kokkos::deep_copy(c, 2.);
  double best = 0;
  for (int k = 0; k < repetitions; ++k) {
    comm.barrier();
    const Kokkos::Timer timer;
    Kokkos::parallel_for(
        "rpc::benchmark::triad", device_range(entries), KOKKOS_LAMBDA(const LO i) { a(i) = b(i) + 3 * c(i); });
    Kokkos::fence();
    const double seconds = max_all(comm, timer.seconds());
    best = std::max(best, 24e-9 * entries * comm.getSize() / seconds);
  }
  return best;
}

/// The beam's body, in space as deep as it is high, its stiffness matrix and what a kernel needs of them.
struct Body {
  fem::Discretization d;
  fem::Material material{2000, 0.3};
  RCP<CrsMatrix> K;

  Body(const std::string &element, const int dim, int n)
  {
    mesh::BoxOptions box{{0, 0}, {5, 1}, {}, mesh::parse_element(element, dim)};
    n /= box.element.order;
    box.cells = {5 * n, n};
    if (dim == 3) {
      box.lower.push_back(0);
      box.upper.push_back(1);
      box.cells.push_back(n);
    }
    d = fem::discretize(std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm())));
    K = fem::assemble_stiffness(d, material);
  }
  RCP<StiffnessOperator> stiffness() const { return rcp(new StiffnessOperator(K, d.dim())); }
  /// From the next level of multigrid: order 1, or half as many cells each way.
  solver::NodeInterpolation from_coarser(RCP<const Map> &coarse_dofs, double &entries) const
  {
    RCP<CrsMatrix> nodes;
    if (d.mesh->element.order == 2) {
      const fem::OrderOne lower = fem::order_one(d);
      coarse_dofs = fem::discretize(lower.mesh).owned_dofs;
      nodes = lower.interpolation;
    } else {
      const auto half = mesh::make_box(*mesh::coarsened(*d.mesh->box), Tpetra::getDefaultComm());
      const auto coarse = fem::discretize(std::make_shared<mesh::Mesh>(half));
      coarse_dofs = coarse.owned_dofs;
      nodes = fem::interpolation(coarse, d);
    }
    entries = static_cast<double>(nodes->getLocalMatrixDevice().nnz());
    const DeviceView<char *> free("rpc::benchmark::free", num_local(*d.owned_dofs)),
        coarse_free("rpc::benchmark::free", num_local(*coarse_dofs));
    return {nodes, d.dim(), free, coarse_free};
  }
  double cells() const { return d.mesh->num_cells(); }
  double rows() const { return num_local(*d.owned_dofs); }
  double entries() const { return static_cast<double>(K->getLocalMatrixDevice().nnz()); }
  /// Coordinates, and nodes and block of each cell.
  double mesh_bytes() const { return 8 * rows() + sizeof(LO) * cells() * (d.mesh->element.num_nodes() + 1); }
  /// Values, columns and row offsets.
  double matrix_bytes() const { return (8 + sizeof(LO)) * entries() + sizeof(std::size_t) * (rows() + 1); }
  /// Neighbours of each node, the pattern that the assembly goes by.
  double node_graph_bytes() const
  {
    const auto nodes = d.nodes();
    return sizeof(std::size_t) * nodes.row.extent(0) + sizeof(LO) * nodes.col.extent(0);
  }
};

/// Runs a kernel as often as Google Benchmark asks for.
/// @param bytes  moved at least   @param flops  0: not counted   @param items  cells or rows
template <class Kernel>
void measure(benchmark::State &state, const double stream, const double bytes, const double flops, const double items,
             const Kernel &kernel)
{
  kernel();                                              // page faults, lazy set-up
  double best = std::numeric_limits<double>::infinity(); // as of the triad
  for (auto _ : state) {
    const Kokkos::Timer timer;
    kernel();
    Kokkos::fence();
    const double seconds = timer.seconds();
    state.SetIterationTime(seconds);
    best = std::min(best, seconds);
  }
  state.counters["items"] = items;
  state.counters["bytes"] = bytes;
  state.counters["flops"] = flops;
  state.counters["ns_per_item"] = 1e9 * best / items;
  state.counters["GB/s"] = 1e-9 * bytes / best;
  state.counters["GFlop/s"] = 1e-9 * flops / best;
  state.counters["of_triad"] = 1e-9 * bytes / best / stream;
}

void assembly(benchmark::State &state, const double stream, const Body &body)
{
  // The pattern is that of the graph: of the matrix only values are written.
  const double bytes = body.mesh_bytes() + body.node_graph_bytes() + 8 * body.entries();
  measure(state, stream, bytes, 0, body.cells(), [&] { fem::assemble_stiffness(body.d, body.material); });
}

void internal_work(benchmark::State &state, const double stream, const Body &body)
{
  Vector u(body.d.owned_dofs);
  u.randomize();
  const double bytes = body.mesh_bytes() + 8 * 2 * body.rows(); // reads u, writes f
  measure(state, stream, bytes, 0, body.cells(), [&] { fem::internal_work(body.d, body.material, u); });
}

/// Rows as KokkosKernels reads them.
void csr_product(benchmark::State &state, const double stream, const Body &body)
{
  Vector x(body.d.owned_dofs), y(body.d.owned_dofs);
  x.randomize();
  const double bytes = body.matrix_bytes() + 8 * 2 * body.rows(); // reads x, writes y
  measure(state, stream, bytes, 2 * body.entries(), body.rows(), [&] { body.K->apply(x, y); });
}

/// Rows that repeat are kept once: a number a node is read instead.
double product_bytes(const Body &body)
{
  return 2 * body.rows() / body.d.dim() + 8 * 2 * body.rows();
}

void product(benchmark::State &state, const double stream, const Body &body)
{
  const auto K = body.stiffness();
  Vector x(body.d.owned_dofs), y(body.d.owned_dofs);
  x.randomize();
  measure(state, stream, product_bytes(body), 2 * body.entries(), body.rows(), [&] { K->apply(x, y); });
}

/// As after the coarse correction: from an approximation that is not zero.
void smoother(benchmark::State &state, const double stream, const Body &body)
{
  const auto K = body.stiffness();
  const solver::NodeSmoother::Options options;
  const auto blocks = K->diagonal_blocks();
  const solver::NodeSmoother smoother(K, blocks, {}, solver::largest_eigenvalue(*K, blocks), options);
  Vector b(body.d.owned_dofs), x(body.d.owned_dofs);
  b.randomize();
  // After each product a step reads the product, the inverse block, b, the step before (the first has none) and x, and writes the
  // step (the last need not) and x.
  const double bytes =
      options.degree * (product_bytes(body) + 8 * (6 + body.d.dim()) * body.rows()) - 8 * 2 * body.rows();
  const double flops = options.degree * (2 * body.entries() + (2 * body.d.dim() + 5) * body.rows());
  measure(state, stream, bytes, flops, body.rows(), [&] { smoother.improve(b, x); });
}

/// The coarse correction is interpolated and added.
void prolongation(benchmark::State &state, const double stream, const Body &body)
{
  RCP<const Map> coarse_dofs;
  double entries = 0;
  const solver::NodeInterpolation interpolation = body.from_coarser(coarse_dofs, entries);
  Vector coarse(coarse_dofs), x(body.d.owned_dofs);
  coarse.randomize();
  const double bytes = (8 + sizeof(LO)) * entries + sizeof(std::size_t) * body.rows() / body.d.dim() +
                       17 * body.rows() + 8 * num_local(*coarse_dofs);
  measure(state, stream, bytes, 2 * body.d.dim() * entries, body.rows(),
          [&] { interpolation.prolong(coarse, x, solver::NodeInterpolation::Write::add); });
}

using Kernel = void (*)(benchmark::State &, double, const Body &);

/// Bodies as they are asked for, one at a time for the memory's sake.
class Bodies
{
public:
  const Body &get(const std::string &element, const int dim, const int n)
  {
    const std::string name = element + std::to_string(dim) + '/' + std::to_string(n);
    if (name != name_) {
      body_.reset();
      body_ = std::make_unique<Body>(element, dim, n);
      name_ = name;
    }
    return *body_;
  }

private:
  std::string name_;
  std::unique_ptr<Body> body_;
};

void register_kernels(const int n, const std::string &element, const int dim, const double stream, Bodies &bodies)
{
  const std::string body = std::to_string(n) + "/" + element + (dim == 3 ? " 3D/" : "/");
  const std::pair<const char *, Kernel> kernels[] = {{"assembly", assembly},       {"internal work", internal_work},
                                                     {"CSR product", csr_product}, {"product", product},
                                                     {"smoother", smoother},       {"prolongation", prolongation}};
  for (const auto &[name, kernel] : kernels)
    benchmark::RegisterBenchmark((body + name).c_str(), [n, element, dim, stream, kernel = kernel,
                                                         &bodies](benchmark::State &state) {
      kernel(state, stream, bodies.get(element, dim, n));
    })->UseManualTime();
}

/// The numbers of an option, separated by commas, or those given where it is absent.
std::vector<int> numbers(const int argc, char **argv, const std::string &option, std::string text)
{
  for (int i = 1; i < argc; ++i)
    if (std::string(argv[i]).rfind(option, 0) == 0) text = std::string(argv[i]).substr(option.size());
  std::vector<int> result;
  std::istringstream stream(text);
  for (std::string number; std::getline(stream, number, ',');) result.push_back(std::stoi(number));
  return result;
}

} // namespace

int main(int argc, char *argv[])
{
#ifdef __GLIBC__ // as in the program: freed memory stays with the process
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 2000 << 20);
  mallopt(M_TOP_PAD, 256 << 20);
#endif
  benchmark::Initialize(&argc, argv);
  const auto in_plane = numbers(argc, argv, "--cells=", "256,512");
  const auto in_space = numbers(argc, argv, "--cells-in-space=", "16,32");
  const Tpetra::ScopeGuard scope(&argc, &argv);
  const auto comm = Tpetra::getDefaultComm();
  const double stream = triad(*comm);
  benchmark::RegisterBenchmark("triad", [stream](benchmark::State &state) {
    for (auto _ : state) {
    }
    state.counters["GB/s"] = stream;
  })->Iterations(1);
  Bodies bodies;
  if (comm->getSize() == 1) // the program's own runs show what more ranks bring
    for (const auto &[dim, sizes] : {std::pair(2, in_plane), std::pair(3, in_space)})
      for (const int n : sizes)
        for (const char *element : {"Q1", "P1", "Q2", "P2"}) register_kernels(n, element, dim, stream, bodies);
  if (comm->getRank() == 0) benchmark::RunSpecifiedBenchmarks();
  return 0;
}
