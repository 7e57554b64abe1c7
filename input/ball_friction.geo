// Half of the lower half of a ball of radius R over the plane z = 0: y >= 0. It touches at the origin, with a contact radius of
// about 0.15 R. Units: m.
DefineConstant[ R = 1, contact_radius = 0.15 * R, h = 0.019 * R ];

Point(1) = {0, 0, R};
Point(2) = {R, 0, R};
Point(3) = {0, R, R};
Point(4) = {-R, 0, R};
Point(5) = {0, 0, 0};
Line(1) = {4, 1};
Line(2) = {1, 2};
Circle(3) = {2, 1, 3};
Circle(4) = {3, 1, 4};
Circle(5) = {2, 1, 5};
Circle(6) = {5, 1, 4};
Circle(7) = {3, 1, 5};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Curve Loop(2) = {1, 2, 5, 6};
Plane Surface(2) = {2};
Curve Loop(3) = {3, 7, -5};
Surface(3) = {3} In Sphere {1}; // nodes, the middle ones too, lie on the sphere
Curve Loop(4) = {4, -6, -7};
Surface(4) = {4} In Sphere {1};
Surface Loop(1) = {1, 2, 3, 4};
Volume(1) = {1};

Physical Volume("ball") = {1};
Physical Surface("top") = {1};
Physical Surface("skin") = {3, 4};
Physical Surface("symmetry_y") = {2};

// Cells of size h in a ball around the contact, growing with the distance beyond.
Field[1] = Ball;
Field[1].Radius = 1.1 * contact_radius;
Field[1].Thickness = R;
Field[1].VIn = h;
Field[1].VOut = 0.3 * R;
Background Field = 1;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeExtendFromBoundary = 0;
