// Quarter of the lower half of a ball of radius R over the plane z = 0: x >= 0, y >= 0. It touches at the origin, with a
// contact radius of about 0.15 R. Units: m.
DefineConstant[ R = 1, contact_radius = 0.15 * R, h = 0.012 * R ];

Point(1) = {0, 0, R};
Point(2) = {R, 0, R};
Point(3) = {0, R, R};
Point(4) = {0, 0, 0};
Line(1) = {1, 2};
Line(2) = {1, 3};
Line(3) = {1, 4};
Circle(4) = {2, 1, 3};
Circle(5) = {3, 1, 4};
Circle(6) = {4, 1, 2};
Curve Loop(1) = {1, 4, -2};
Plane Surface(1) = {1};
Curve Loop(2) = {2, 5, -3};
Plane Surface(2) = {2};
Curve Loop(3) = {3, 6, -1};
Plane Surface(3) = {3};
Curve Loop(4) = {4, 5, 6};
Surface(4) = {4} In Sphere {1}; // nodes, the middle ones too, lie on the sphere
Surface Loop(1) = {1, 2, 3, 4};
Volume(1) = {1};

Physical Volume("ball") = {1};
Physical Surface("top") = {1};
Physical Surface("skin") = {4};
Physical Surface("symmetry_x") = {2};
Physical Surface("symmetry_y") = {3};

// Cells of size h in a ball around the contact, growing with the distance beyond.
Field[1] = Ball;
Field[1].Radius = 1.1 * contact_radius;
Field[1].Thickness = R;
Field[1].VIn = h;
Field[1].VOut = 0.3 * R;
Background Field = 1;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeExtendFromBoundary = 0;
