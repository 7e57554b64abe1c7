// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"
#include "rpc/core/units.hpp"

#include <string>
#include <vector>

namespace rpc::io
{

/// A field of comma-separated values as RFC 4180 has it: in quotes if it holds a comma, a quote or a line's end.
std::string csv_quoted(const std::string &text);

/// What is known of this rank's nodes of one contact side; each node is on one rank.
struct ContactTable {
  std::string side;
  HostView<GO *> id;            ///< (nodes) rank-independent node id
  HostView<double **> position; ///< (nodes, dim)                     [m]
  HostView<double *> weight;    ///< (nodes) of the quadrature         [m^(dim-1)]
  HostView<double *> u_nu;      ///< (nodes) normal displacement       [m]
  HostView<double *> gap;       ///< (nodes)                           [m]
  HostView<double *> pressure;  ///< (nodes) compression is > 0        [Pa]
  HostView<double *> dent;      ///< (nodes) of the foundation         [m]
  HostView<int *> state;        ///< (nodes) 0 open, 1 closed, 2 yielding, 3 unseen
  HostView<double **> along;    ///< (nodes, dim) displacement along the side [m]
  HostView<double **> force;    ///< (nodes, dim) of the foundation on the body [N]
  bool friction = false;        ///< whether the file has the columns of friction, which follow: the same on all ranks
  HostView<double **> traction; ///< (nodes, dim) of the body on the foundation, along the side [Pa]
  HostView<double **> slip;     ///< (nodes, dim) of the step          [m]
  HostView<double *> used;      ///< (nodes) |traction| over what friction bears
  HostView<int *> slip_state;   ///< (nodes) 0 no friction acts, 1 sticks, 2 slips
  HostView<GO **> facets; ///< (facets, facet nodes) node ids, the two ends first; each facet of the side once over
                          ///< all ranks. A node that the table lacks is passed over. Not used in 3D. See
                          ///< mesh::owned_facets()
};

/// Writes the contact nodes as comma-separated values, whole or not at all; collective on comm.
///
/// Sides come one after another. 2D: columns x, y, s, u_nu, gap, pressure, state, side, dent; rows follow the chain of facets from its end with the smaller x,
/// then y, and s is the length of the way from there, straight from node to node [m]. Several chains follow each other
/// by their first point, each with its own s; a closed one starts at its point with the smallest x, then y. 3D: columns
/// x, y, z, area, u_nu, gap, pressure, state, side, dent, with the weight of the node as area [m^2]; rows by id. With friction in any table the columns q_x, q_y (, q_z), slip_x, slip_y (, slip_z), friction_used, friction_state
/// follow, 0 and none where a table has none. The last columns are u_t_x, u_t_y (, u_t_z), force_x, force_y (, force_z). Numbers read back as the same doubles; the file does not depend on
/// the number of ranks. Units other than m and N stand behind the names of columns, "gap [mm]".
/// @param per_length  whether forces are per length, as of a plane body
/// @throws rpc::Error on every rank: bad_input for a folder that cannot be written to, internal_error for a failed
/// write, columns
///         of different lengths, an id that comes twice or a state that does not exist
void write_contact_csv(const std::string &path, const RCP<const Comm> &comm, const std::vector<ContactTable> &tables,
                       const UnitNames &units = {}, bool per_length = false);

} // namespace rpc::io
