// Half cylinder of radius R over the plane y = 0 (Example 2 of Namm & Tsoy 2025): contact where |x| <= 2. Units: m.
DefineConstant[ R = 8, contact_half_width = 2, h = 0.025 ];

y = R - Sqrt(R^2 - contact_half_width^2);
Point(1) = {0, R, 0};
Point(2) = {-R, R, 0};
Point(3) = {-contact_half_width, y, 0};
Point(4) = {0, 0, 0};
Point(5) = {contact_half_width, y, 0};
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
Physical Curve("free") = {1, 4};

// Cells of size h up to 1.25 from the lowest point, which holds the contact for all xi, growing with the distance beyond.
Field[1] = Ball;
Field[1].Radius = 1.25;
Field[1].Thickness = 10;
Field[1].VIn = h;
Field[1].VOut = 1.6;
Background Field = 1;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.Algorithm = 6; // Frontal-Delaunay
