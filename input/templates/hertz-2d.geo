// Half cylinder of radius R above the plane y = 0, which it touches at the origin. Units: mm.
R = 10;
h = 0.02;  // size of the cells where it may touch: about a tenth of the half width of the contact
w = 1;     // half width of the side "contact": wider than the contact will be

y = R - Sqrt(R^2 - w^2);
Point(1) = {0, R, 0};
Point(2) = {-R, R, 0};
Point(3) = {-w, y, 0};
Point(4) = {0, 0, 0};
Point(5) = {w, y, 0};
Point(6) = {R, R, 0};
Circle(1) = {2, 1, 3};
Circle(2) = {3, 1, 4};
Circle(3) = {4, 1, 5};
Circle(4) = {5, 1, 6};
Line(5) = {6, 2};
Curve Loop(1) = {1, 2, 3, 4, 5};
Plane Surface(1) = {1};

Physical Surface("body") = {1};
Physical Curve("contact") = {2, 3};
Physical Curve("top") = {5};

// Cells of size h within 0.5 of the lowest point, growing with the distance beyond.
Field[1] = Ball;
Field[1].Radius = 0.5;
Field[1].Thickness = 10;
Field[1].VIn = h;
Field[1].VOut = 1.5;
Background Field = 1;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeExtendFromBoundary = 0;
