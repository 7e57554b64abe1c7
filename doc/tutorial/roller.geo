// The lower half of a roller of radius R over the plane y = 0, which it touches at the origin. Units: mm.
R = 10;
w = 2; // half the width of the side that may come into contact

Point(1) = {0, R, 0};
Point(2) = {-R, R, 0};
Point(3) = {-w, R - Sqrt(R^2 - w^2), 0};
Point(4) = {0, 0, 0};
Point(5) = {w, R - Sqrt(R^2 - w^2), 0};
Point(6) = {R, R, 0};
Circle(1) = {2, 1, 3};
Circle(2) = {3, 1, 4};
Circle(3) = {4, 1, 5};
Circle(4) = {5, 1, 6};
Line(5) = {6, 1};
Line(6) = {1, 2};
Curve Loop(1) = {1, 2, 3, 4, 5, 6};
Plane Surface(1) = {1};

Physical Surface("steel") = {1};    // the body
Physical Curve("contact") = {2, 3}; // its sides, by the names that the deck uses
Physical Curve("top") = {5, 6};
Physical Point("axis") = {1};       // a point to hold the body at

// Cells of 0.025 within 0.5 of the origin, growing to 2.
Field[1] = Ball;
Field[1].Radius = 0.5;
Field[1].Thickness = 10;
Field[1].VIn = 0.025;
Field[1].VOut = 2;
Background Field = 1;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeExtendFromBoundary = 0;
