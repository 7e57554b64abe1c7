// The section of a half space of revolution above y = 0 with a punch of radius 1, cut off by the ellipse whose foci are the ends of the
// punch: there the exact solution is short. Units: m.
DefineConstant[ b = 4, h = 0.5 ];

a = Sqrt(1 + b^2);
Point(1) = {0, 0, 0};
Point(2) = {a, 0, 0};
Point(3) = {0, b, 0};
Point(4) = {1, 0, 0};
Line(1) = {1, 4};
Line(4) = {4, 2};
Ellipse(2) = {2, 1, 2, 3};
Line(3) = {3, 1};
Curve Loop(1) = {1, 4, 2, 3};
Plane Surface(1) = {1};

Physical Surface("body") = {1};
Physical Curve("punch") = {1};
Physical Curve("far") = {2};
Physical Curve("axis") = {3};

MeshSize{ : } = h;
Mesh.Algorithm = 6; // Frontal-Delaunay
