// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace rpc::solver
{

/// How a linear solve went that was not good. Values are bits.
enum Outcome : unsigned {
  slow = 1,   ///< it converged, in more than LinearRules::slow iterations
  failed = 2, ///< it stopped before it converged
  broken = 4, ///< the set-up or the Krylov method broke down: the matrix may be singular
  dear = 8    ///< it was given up, for a sparse factor takes less time than the iterations that were left
};

/// What it was preconditioned with.
enum class Used {
  meshes,       ///< multigrid on coarser meshes
  mixed,        ///< a mixed form with multigrid on coarser meshes
  meshes_again, ///< the same, after matrices were met that neither hierarchy could solve for
  stand_in,     ///< factor or algebraic hierarchy, in the solve in which multigrid on meshes failed
  factor,       ///< of H, of few unknowns
  algebraic,    ///< a hierarchy that followed changes of states, or reused parts
  from_scratch, ///< a hierarchy made from nothing for these states
  sparse,       ///< a sparse factor that followed changes of states
  sparse_fresh  ///< a sparse factor made for these states
};

/// What takes over: in the same solve where it failed, broke down or was given up, for the next one where it was slow.
enum class Next {
  nothing,    ///< the result stands
  stand_in,   ///< the factor or the algebraic hierarchy, instead of meshes
  anew,       ///< the same, from nothing
  sparse,     ///< a sparse factor, where memory allows one
  whole,      ///< multigrid on coarser meshes for the whole matrix, instead of the mixed form
  whole_once, ///< the same for this solve alone
  stronger,   ///< the algebraic hierarchy with a stronger smoother; once, and not against the deck
  meshes_back ///< multigrid on meshes, for the next solve; the result stands: the matrix is singular
};

/// A row of the policy.
struct PolicyRow {
  Used used;
  unsigned outcomes; ///< for which it holds
  Next next;
  Next otherwise; ///< where that cannot be had
};

// clang-format off
/// The whole policy of what is tried where a linear solve fails or is slow. There is one row for each case.
constexpr PolicyRow policy[] = {
    // after               that was                next          otherwise
    {Used::meshes,         dear | failed,          Next::sparse, Next::stand_in},     // coarse meshes miss what the matrix tells; it stays
    {Used::meshes,         slow,                   Next::nothing, Next::nothing},     // a factor would take longer
    {Used::meshes,         broken,                 Next::stand_in, Next::nothing},    // coarse meshes miss what the matrix tells
    {Used::mixed,          dear,                   Next::sparse, Next::whole},        // a factor takes less time
    {Used::mixed,          slow,                   Next::nothing, Next::nothing},     // a factor would take longer
    {Used::mixed,          failed,                 Next::whole, Next::nothing},       // cells are too stretched for it
    {Used::mixed,          broken,                 Next::whole_once, Next::nothing},  // an active set may leave the body unheld
    {Used::meshes_again,   dear | failed,          Next::sparse, Next::stand_in},     // the same
    {Used::meshes_again,   slow,                   Next::nothing, Next::nothing},     // the same
    {Used::meshes_again,   broken,                 Next::nothing, Next::nothing},     // an active set leaves the body unheld, once more
    {Used::stand_in,       dear | failed,          Next::sparse, Next::stronger},     // aggregation misses slow modes
    {Used::stand_in,       slow,                   Next::stronger, Next::nothing},    // the same, and a factor would take longer
    {Used::stand_in,       broken,                 Next::meshes_back, Next::nothing}, // not the hierarchy: an active set leaves the body unheld
    {Used::factor,         dear | slow | failed,   Next::sparse, Next::stronger},     // its rounding is too large
    {Used::factor,         broken,                 Next::nothing, Next::nothing},     // the matrix is singular
    {Used::algebraic,      dear,                   Next::sparse, Next::anew},         // aggregation misses slow modes
    {Used::algebraic,      slow | failed | broken, Next::anew, Next::nothing},        // corrections or reused parts may be to blame
    {Used::from_scratch,   dear | failed,          Next::sparse, Next::stronger},     // aggregation misses slow modes
    {Used::from_scratch,   slow,                   Next::stronger, Next::nothing},    // the same, and a factor would take longer
    {Used::from_scratch,   broken,                 Next::nothing, Next::nothing},     // the matrix is singular
    {Used::sparse,         ~0U,                    Next::anew, Next::nothing},        // corrections may be to blame
    {Used::sparse_fresh,   ~0U,                    Next::nothing, Next::nothing},     // the matrix is singular, or nearly so
};
// clang-format on

/// The row for a case.
const PolicyRow &rule_for(Used used, Outcome outcome);

} // namespace rpc::solver
