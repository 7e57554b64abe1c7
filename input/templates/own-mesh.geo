// A body for rpc: its shape, and names for its parts. Units: mm.
SetFactory("OpenCASCADE");

// For a STEP file put its name here, and remove the three lines below that make a plate with a hole:
// Merge "body.step";
Box(1) = {-20, -10, 0, 40, 20, 10};
Cylinder(2) = {0, 0, -1, 0, 0, 12, 5};
BooleanDifference(3) = {Volume{1}; Delete;}{Volume{2}; Delete;};

// The whole body is one block.
Physical Volume("body") = {Volume{:}};

// Sides are found by boxes around them, {x, y, z of one corner, x, y, z of the other}: all surfaces within.
// With the graphical gmsh their numbers can be read instead: Physical Surface("foot") = {5};
e = 1e-3;
foot() = Surface In BoundingBox {-20 - e, -10 - e, -e, 20 + e, 10 + e, e};
top() = Surface In BoundingBox {-20 - e, -10 - e, 10 - e, 20 + e, 10 + e, 10 + e};
Physical Surface("foot") = {foot()};
Physical Surface("top") = {top()};

Mesh.MeshSizeMax = 2.5;  // of the cells
// Finer where a small contact is expected:
// MeshSize{ PointsOf{ Surface{foot()}; } } = 0.5;
