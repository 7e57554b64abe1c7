// A quarter of the lower half of a ball of radius R, which touches the plane z = 0 at the origin. Units: mm.
SetFactory("OpenCASCADE");
R = 10;
h = 0.1;  // size of the cells where it may touch: about a quarter of the radius of the contact

Sphere(1) = {0, 0, R, R, -Pi / 2, 0, Pi / 2};
Physical Volume("body") = {1};

// Its surfaces, found by boxes around them: all of "symmetry x" lies in x = 0, and so on.
e = 1e-3;
top() = Surface In BoundingBox {-e, -e, R - e, R + e, R + e, R + e};
symmetry_x() = Surface In BoundingBox {-e, -e, -e, e, R + e, R + e};
symmetry_y() = Surface In BoundingBox {-e, -e, -e, R + e, e, R + e};
all() = Boundary {Volume{1};};
skin() = all();
skin() -= {top(), symmetry_x(), symmetry_y()};
Physical Surface("top") = {top()};
Physical Surface("symmetry x") = {symmetry_x()};
Physical Surface("symmetry y") = {symmetry_y()};
Physical Surface("skin") = {skin()};

// Cells of size h within 0.6 of the lowest point, growing with the distance beyond.
Field[1] = Ball;
Field[1].Radius = 0.6;
Field[1].Thickness = 12;
Field[1].VIn = h;
Field[1].VOut = 3;
Background Field = 1;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeExtendFromBoundary = 0;
