#include "rpc/fem/hinges.hpp"

#include "point_text.hpp"
#include "rpc/core/fingerprint.hpp"
#include "rpc/core/on_root.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/fem/rigid_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace rpc::fem
{
namespace
{

using DenseRows = std::vector<std::vector<double>>;

/// Pieces joined to each other in points, of which motions are worked out all at once.
constexpr std::size_t most_pieces = 200;

/// They are a facet's first nodes.
int num_facet_vertices(const mesh::Element &element)
{
  return element.dim == 2 ? 2 : element.shape == mesh::Shape::tensor ? 4 : 3;
}

/// Counts the owned nodes where the cells around are not all joined over facets that hold the node.
struct CountPinchedNodes {
  static constexpr int most_cells = 64; // around a node; one with more counts

  DeviceView<LO **> cells;   // (cells, nodes)            in
  NodeToCells node_to_cells; //                           in
  DeviceView<int **> facets; // (facets, their vertices)  in, nodes of a cell
  int num_vertices;          // of a cell                 in

  /// A number for the facet, 0 if the node is none of its vertices.
  KOKKOS_FUNCTION std::uint64_t facet_at(const LO cell, const int facet, const LO node) const
  {
    std::uint64_t sum = 0;
    bool holds = false;
    for (std::size_t a = 0; a < facets.extent(1); ++a) {
      const LO vertex = cells(cell, facets(facet, a));
      holds = holds || vertex == node;
      sum += splitmix64(static_cast<std::uint64_t>(vertex)); // the sum of several tells the numbers
    }
    return holds ? sum : 0;
  }
  KOKKOS_FUNCTION bool is_vertex(const LO cell, const LO node) const
  {
    for (int a = 0; a < num_vertices; ++a)
      if (cells(cell, a) == node) return true;
    return false;
  }
  KOKKOS_FUNCTION bool share_facet(const LO a, const LO b, const LO node) const
  {
    const int num_facets = static_cast<int>(facets.extent(0));
    for (int f = 0; f < num_facets; ++f) {
      const std::uint64_t of_a = facet_at(a, f, node);
      for (int g = 0; of_a != 0 && g < num_facets; ++g)
        if (facet_at(b, g, node) == of_a) return true;
    }
    return false;
  }
  /// Inside of the body each facet around the node belongs to two cells: these numbers cancel.
  KOKKOS_FUNCTION bool is_inside(const LO node) const
  {
    std::uint64_t bits = 0;
    for (std::size_t k = node_to_cells.row(node); k < node_to_cells.row(node + 1); ++k)
      for (std::size_t f = 0; f < facets.extent(0); ++f)
        bits ^= facet_at(node_to_cells.cell(k), static_cast<int>(f), node);
    return bits == 0;
  }
  KOKKOS_FUNCTION void operator()(const LO node, LO &count) const
  {
    const std::size_t first = node_to_cells.row(node);
    const int size = static_cast<int>(node_to_cells.row(node + 1) - first);
    if (size < 2 || !is_vertex(node_to_cells.cell(first), node) || is_inside(node)) return;
    if (size > most_cells) {
      ++count;
      return;
    }
    bool reached[most_cells] = {true}; // from the first cell
    int num_reached = 1;
    for (int before = 0; before < num_reached;) {
      before = num_reached;
      for (int a = 0; a < size; ++a)
        for (int b = 0; reached[a] && b < size; ++b)
          if (!reached[b] && share_facet(node_to_cells.cell(first + a), node_to_cells.cell(first + b), node)) {
            reached[b] = true;
            ++num_reached;
          }
    }
    if (num_reached < size) ++count;
  }
};

/// Whether there are such nodes on any rank; collective.
bool has_pinched_nodes(const Discretization &d)
{
  const mesh::Element &element = d.mesh->element;
  const auto &facets = element.facets();
  const int width = num_facet_vertices(element);
  const DeviceView<int **> facet_vertices("rpc::fem::facet_vertices", facets.size(), width);
  const auto mirror = Kokkos::create_mirror_view(facet_vertices);
  for (std::size_t f = 0; f < facets.size(); ++f)
    for (int a = 0; a < width; ++a) mirror(f, a) = facets[f][a];
  Kokkos::deep_copy(facet_vertices, mirror);
  LO count = 0;
  Kokkos::parallel_reduce("rpc::fem::pinched_nodes", device_range(d.mesh->num_owned_nodes()),
                          CountPinchedNodes{d.mesh->cells, d.node_to_cells, facet_vertices, element.num_vertices()},
                          count);
  return max_all(d.mesh->comm(), count) > 0;
}

/// Sets that join.
class Sets
{
public:
  explicit Sets(const int count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

  int find(int n)
  {
    while (parent_[n] != n) n = parent_[n] = parent_[parent_[n]];
    return n;
  }
  void join(const int a, const int b) { parent_[std::max(find(a), find(b))] = std::min(find(a), find(b)); }
  /// (items) the number of each one's set, from 0.
  std::vector<int> numbers()
  {
    std::vector<int> number(parent_.size());
    int count = 0;
    for (int n = 0; n < static_cast<int>(parent_.size()); ++n) number[n] = find(n) == n ? count++ : number[find(n)];
    return number;
  }

private:
  std::vector<int> parent_; // of a root itself; others come after theirs
};

int count_of(const std::vector<int> &numbers)
{
  return numbers.empty() ? 0 : 1 + *std::max_element(numbers.begin(), numbers.end());
}

/// Where pieces are: a box that holds their nodes.
struct Box {
  std::array<double, 3> lower, upper; // [m]

  Box()
  {
    lower.fill(std::numeric_limits<double>::infinity());
    upper.fill(-std::numeric_limits<double>::infinity());
  }
  void add(const double *const from, const double *const to, const int dim)
  {
    for (int c = 0; c < dim; ++c) {
      lower[c] = std::min(lower[c], from[c]);
      upper[c] = std::max(upper[c], to[c]);
    }
  }
  Part frame(const int dim) const
  {
    Part part;
    double squares = 0;
    for (int c = 0; c < dim; ++c) {
      part.centre[c] = (lower[c] + upper[c]) / 2;
      squares += std::pow((upper[c] - lower[c]) / 2, 2);
    }
    part.radius = std::sqrt(squares);
    return part;
  }
};

/// A force of size 1 at a place, along one piece's modes.
RigidMotion row_at(const double *const x, const int direction, const Part &frame, const int dim)
{
  double arm[3] = {0, 0, 0}, unit[3] = {0, 0, 0};
  for (int c = 0; c < dim; ++c) arm[c] = (x[c] - frame.centre[c]) / frame.radius;
  unit[direction] = 1;
  RigidMotion row{};
  along_modes(dim, arm, unit, row.data());
  return row;
}

/// The same force and moment along the modes of another frame.
RigidMotion moved(const RigidMotion &row, const Part &from, const Part &to, const int dim)
{
  double arm[3] = {0, 0, 0}, force[3] = {0, 0, 0};
  for (int c = 0; c < dim; ++c) {
    arm[c] = (from.centre[c] - to.centre[c]) / to.radius;
    force[c] = row[c];
  }
  RigidMotion result{};
  along_modes(dim, arm, force, result.data());
  for (int k = dim; k < 6; ++k) result[k] += row[k] * from.radius / to.radius;
  return result;
}

/// What ranks know of their pieces; lists of all ranks, on rank 0 alone, name pieces over all ranks.
struct Pieces {
  std::vector<GO> num_cells;    // (pieces) owned
  std::vector<double> box;      // (pieces, 2 dim) of the nodes of local cells [m]
  std::vector<GO> shared;       // (cells that several ranks have, vertices + 1) gids ascending, piece
  std::vector<GO> joined;       // (joints, 2) pieces
  std::vector<double> joint;    // (joints, dim) [m]
  std::vector<GO> held;         // (rows) piece
  std::vector<double> held_row; // (rows, 6) along the modes of the piece's box on that rank
};

/// (local cells) the piece of each, by facets that they share on this rank.
template <class Cells>
std::vector<int> local_pieces(const mesh::Mesh &mesh, const Cells &cells)
{
  const mesh::Element &element = mesh.element;
  const int width = num_facet_vertices(element);
  Sets sets(mesh.num_cells());
  std::map<std::vector<LO>, LO> first;
  for (LO cell = 0; cell < mesh.num_cells(); ++cell)
    for (const auto &facet : element.facets()) {
      std::vector<LO> key;
      for (int a = 0; a < width; ++a) key.push_back(cells(cell, facet[a]));
      std::sort(key.begin(), key.end());
      const auto [other, fresh] = first.emplace(key, cell);
      if (!fresh) sets.join(other->second, cell);
    }
  return sets.numbers();
}

/// Collective.
Pieces pieces_of(const Discretization &d, const DirichletDofs &dirichlet)
{
  const mesh::Mesh &mesh = *d.mesh;
  const Comm &comm = mesh.comm();
  const int dim = d.dim(), width = mesh.element.num_nodes(), vertices = mesh.element.num_vertices();
  const auto cells = to_host(mesh.cells);
  const auto coords = to_host(mesh.coords);
  const auto fixed = to_host(dirichlet.fixed);
  const auto row = to_host(d.node_to_cells.row);
  const auto around = to_host(d.node_to_cells.cell);
  const std::vector<int> piece = local_pieces(mesh, cells);
  const int count = count_of(piece);
  GO offset = 0;
  const auto counts = gathered_by_all(comm, std::vector<GO>{count});
  for (int rank = 0; rank < comm.getRank(); ++rank) offset += counts[rank];

  Pieces mine;
  mine.num_cells.assign(count, 0);
  std::vector<Box> boxes(count);
  for (LO cell = 0; cell < mesh.num_cells(); ++cell) {
    mine.num_cells[piece[cell]] += cell < mesh.num_owned_cells;
    bool shared = false;
    std::vector<GO> key;
    for (int a = 0; a < width; ++a) {
      double x[3] = {0, 0, 0};
      for (int c = 0; c < dim; ++c) x[c] = coords(cells(cell, a), c);
      boxes[piece[cell]].add(x, x, dim);
      if (a >= vertices) continue;
      shared = shared || cells(cell, a) >= mesh.num_owned_nodes();
      key.push_back(mesh.overlap_nodes->getGlobalElement(cells(cell, a)));
    }
    if (!shared) continue;
    std::sort(key.begin(), key.end());
    mine.shared.insert(mine.shared.end(), key.begin(), key.end());
    mine.shared.push_back(offset + piece[cell]);
  }
  std::vector<Part> frames;
  for (const Box &box : boxes) {
    frames.push_back(box.frame(dim));
    mine.box.insert(mine.box.end(), box.lower.begin(), box.lower.begin() + dim);
    mine.box.insert(mine.box.end(), box.upper.begin(), box.upper.begin() + dim);
  }
  std::vector<std::vector<RigidMotion>> rows(count);
  for (LO n = 0; n < mesh.num_owned_nodes(); ++n) {
    std::set<int> here;
    for (std::size_t k = row(n); k < row(n + 1); ++k) here.insert(piece[around(k)]);
    double x[3] = {0, 0, 0};
    for (int c = 0; c < dim; ++c) x[c] = coords(n, c);
    for (auto other = std::next(here.begin()); other != here.end(); ++other) {
      mine.joined.insert(mine.joined.end(), {offset + *here.begin(), offset + *other});
      mine.joint.insert(mine.joint.end(), x, x + dim);
    }
    for (int c = 0; c < dim; ++c)
      for (const int p : here)
        if (fixed(dim * n + c)) rows[p].push_back(row_at(x, c, frames[p], dim));
  }
  for (int p = 0; p < count; ++p)
    for (const RigidMotion &held : independent_rows(rows[p], rigid_tolerance)) {
      mine.held.push_back(offset + p);
      mine.held_row.insert(mine.held_row.end(), held.begin(), held.end());
    }
  return {gathered_by_root(comm, mine.num_cells), gathered_by_root(comm, mine.box),
          gathered_by_root(comm, mine.shared),    gathered_by_root(comm, mine.joined),
          gathered_by_root(comm, mine.joint),     gathered_by_root(comm, mine.held),
          gathered_by_root(comm, mine.held_row)};
}

double dot_of_rows(const std::vector<double> &a, const std::vector<double> &b)
{
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.);
}

/// a -= (a.unit) unit.
void subtract(std::vector<double> &a, const std::vector<double> &unit)
{
  const double part = dot_of_rows(a, unit);
  for (std::size_t k = 0; k < a.size(); ++k) a[k] -= part * unit[k];
}

/// Orthonormal basis of what rows of size 1 span, the largest remainder first.
DenseRows basis_of(const DenseRows &rows, const double tolerance)
{
  DenseRows rest = rows, units;
  for (;;) {
    std::size_t best = rest.size();
    double largest = tolerance * tolerance;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      if (!units.empty()) subtract(rest[i], units.back());
      const double square = dot_of_rows(rest[i], rest[i]);
      if (!(square > largest)) continue;
      largest = square;
      best = i;
    }
    if (best == rest.size()) return units;
    std::vector<double> unit = rest[best];
    for (const auto &other : units) subtract(unit, other); // again, so that the rest is orthogonal to rounding
    const double size = std::sqrt(dot_of_rows(unit, unit));
    for (double &entry : unit) entry /= size;
    units.push_back(unit);
  }
}

/// Pieces of the whole body that points join to each other.
struct Assembly {
  struct Joint {
    Point x; // [m]
    int a, b;
  };
  std::vector<Part> pieces; // centre, radius, number of cells
  std::vector<Joint> joints;
  std::vector<std::vector<RigidMotion>> held; // (pieces) along its modes
  Part whole;
};

/// Rank 0 only.
std::vector<Assembly> assemblies_of(const Pieces &all, const int dim, const int vertices)
{
  const int count = static_cast<int>(all.num_cells.size());
  Sets sets(count);
  std::map<std::vector<GO>, GO> first;
  for (std::size_t k = 0; k < all.shared.size(); k += vertices + 1) {
    const auto key = all.shared.begin() + static_cast<std::ptrdiff_t>(k);
    const auto [other, fresh] = first.emplace(std::vector<GO>(key, key + vertices), key[vertices]);
    if (!fresh) sets.join(static_cast<int>(other->second), static_cast<int>(key[vertices]));
  }
  const std::vector<int> piece = sets.numbers();
  const int num_pieces = count_of(piece);
  Sets joined(num_pieces);
  for (std::size_t j = 0; j < all.joined.size(); j += 2) joined.join(piece[all.joined[j]], piece[all.joined[j + 1]]);
  const std::vector<int> assembly = joined.numbers();

  std::vector<Assembly> assemblies(count_of(assembly));
  std::vector<Box> boxes(num_pieces), whole(assemblies.size());
  std::vector<GO> num_cells(num_pieces, 0);
  for (int p = 0; p < count; ++p) {
    const double *const box = &all.box[2 * dim * p];
    boxes[piece[p]].add(box, box + dim, dim);
    whole[assembly[piece[p]]].add(box, box + dim, dim);
    num_cells[piece[p]] += all.num_cells[p];
  }
  std::vector<int> place(num_pieces);
  for (int p = 0; p < num_pieces; ++p) {
    Assembly &to = assemblies[assembly[p]];
    place[p] = static_cast<int>(to.pieces.size());
    to.pieces.push_back(boxes[p].frame(dim));
    to.pieces.back().num_cells = num_cells[p];
    to.held.emplace_back();
    to.whole = whole[assembly[p]].frame(dim);
  }
  for (std::size_t j = 0; 2 * j < all.joined.size(); ++j) {
    const int a = piece[all.joined[2 * j]], b = piece[all.joined[2 * j + 1]];
    if (a == b) continue;
    Point x{};
    std::copy_n(&all.joint[dim * j], dim, x.begin());
    assemblies[assembly[a]].joints.push_back({x, place[a], place[b]});
  }
  for (Assembly &of : assemblies) { // in an order that ranks have no part in
    for (auto &joint : of.joints)
      if (of.pieces[joint.b].centre < of.pieces[joint.a].centre) std::swap(joint.a, joint.b);
    std::sort(of.joints.begin(), of.joints.end(), [](const auto &one, const auto &other) { return one.x < other.x; });
  }
  for (std::size_t k = 0; k < all.held.size(); ++k) {
    const int p = static_cast<int>(all.held[k]);
    Assembly &to = assemblies[assembly[piece[p]]];
    const int at = place[piece[p]];
    Box box;
    box.add(&all.box[2 * dim * p], &all.box[2 * dim * p] + dim, dim);
    RigidMotion row;
    std::copy_n(&all.held_row[6 * k], 6, row.begin());
    to.held[at].push_back(moved(row, box.frame(dim), to.pieces[at], dim));
  }
  return assemblies;
}

/// What stops motions of the pieces, each by all its modes: prescribed displacements, and places that two of them share.
DenseRows stopped(const Assembly &assembly, const int dim)
{
  const std::size_t modes = num_rigid_modes(dim), size = modes * assembly.pieces.size();
  DenseRows rows;
  const auto put = [&](std::vector<double> &row, const RigidMotion &motion, const int piece, const double factor) {
    for (std::size_t k = 0; k < modes; ++k) row[modes * piece + k] = factor * motion[k];
  };
  for (std::size_t p = 0; p < assembly.pieces.size(); ++p)
    for (const RigidMotion &held : independent_rows(assembly.held[p], rigid_tolerance)) {
      rows.emplace_back(size, 0.);
      put(rows.back(), held, static_cast<int>(p), 1 / std::sqrt(dot(held, held)));
    }
  for (const auto &joint : assembly.joints)
    for (int c = 0; c < dim; ++c) {
      rows.emplace_back(size, 0.);
      put(rows.back(), row_at(joint.x.data(), c, assembly.pieces[joint.a], dim), joint.a, std::sqrt(0.5));
      put(rows.back(), row_at(joint.x.data(), c, assembly.pieces[joint.b], dim), joint.b, -std::sqrt(0.5));
    }
  return rows;
}

/// How many motions prescribed displacements leave to the pieces as one body.
std::size_t num_free_as_one(const Assembly &assembly, const int dim)
{
  std::vector<RigidMotion> rows;
  for (std::size_t p = 0; p < assembly.pieces.size(); ++p)
    for (const RigidMotion &held : assembly.held[p])
      rows.push_back(moved(held, assembly.pieces[p], assembly.whole, dim));
  return num_rigid_modes(dim) - independent_rows(rows, rigid_tolerance).size();
}

/// The joint about which pieces turn most, for a basis of what stops them.
const Assembly::Joint &loosest(const Assembly &assembly, const DenseRows &units, const int dim)
{
  const std::size_t modes = num_rigid_modes(dim), size = modes * assembly.pieces.size();
  std::size_t best = 0;
  double most = 0;
  for (std::size_t k = 0; k < size; ++k) { // projections of unit motions span what is left
    std::vector<double> motion(size, 0.);
    motion[k] = 1;
    for (int pass = 0; pass < 2; ++pass)
      for (const auto &unit : units) subtract(motion, unit);
    for (std::size_t j = 0; j < assembly.joints.size(); ++j) {
      const auto &joint = assembly.joints[j];
      const double a = assembly.pieces[joint.a].radius, b = assembly.pieces[joint.b].radius;
      double squares = 0;
      for (std::size_t mode = dim; mode < modes; ++mode)
        squares += std::pow(motion[modes * joint.a + mode] / a - motion[modes * joint.b + mode] / b, 2) * a * b;
      if (squares > most * (1 + 1e-6)) {
        most = squares;
        best = j;
      }
    }
  }
  return assembly.joints[best];
}

void check(const Assembly &assembly, const int dim)
{
  if (assembly.pieces.size() < 2) return;
  const std::string only = dim == 2 ? "in single points only" : "in single points or along edges only";
  const std::string remedy = std::string(". Join them over ") + (dim == 2 ? "an edge" : "a face") +
                             " of cells, or prescribe displacements in \"Dirichlet\" that hold each of them.";
  RPC_REQUIRE_CODE(assembly.pieces.size() <= most_pieces, ExitCode::no_solution,
                   "support: the mesh joins " << assembly.pieces.size() << " pieces of the body " << only
                                              << ", too many to tell whether something holds each" << remedy);
  const DenseRows units = basis_of(stopped(assembly, dim), rigid_tolerance);
  const std::size_t free = num_rigid_modes(dim) * assembly.pieces.size() - units.size();
  if (free <= num_free_as_one(assembly, dim)) return;
  const auto &joint = loosest(assembly, units, dim);
  const auto text = [&](const int piece) {
    const Part &p = assembly.pieces[piece];
    return std::to_string(p.num_cells) + (p.num_cells == 1 ? " cell" : " cells") + " around " +
           point_text(p.centre, dim, p.radius);
  };
  throw Error(ExitCode::no_solution, "support: the mesh joins a piece of " + text(joint.a) + " and one of " +
                                         text(joint.b) + " " + only + ", as at " +
                                         point_text(joint.x, dim, assembly.whole.radius) +
                                         ", where they can rotate against each other, and no prescribed displacement "
                                         "stops that" +
                                         remedy);
}

} // namespace

void require_stiff_joints(const Discretization &d, const DirichletDofs &dirichlet)
{
  const bool is_box = d.mesh->box != nullptr; // whose cells are joined over their facets
  if (is_box || d.axisymmetric() || !has_pinched_nodes(d)) return;
  const Pieces pieces = pieces_of(d, dirichlet);
  on_root(d.mesh->comm(), ExitCode::internal_error, [&] {
    for (const Assembly &assembly : assemblies_of(pieces, d.dim(), d.mesh->element.num_vertices()))
      check(assembly, d.dim());
  });
}

} // namespace rpc::fem
