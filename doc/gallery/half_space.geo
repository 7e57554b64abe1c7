// Half of the plane above y = 0, or the section of a half space of revolution, cut off by the ellipse with foci at x = -1 and 1: there the exact solutions of
// contact with a half width or radius of 1 are short. Units: m.
DefineConstant[ b = 4, h = 0.5 ];

a = Sqrt(1 + b^2);
Point(1) = {0, 0, 0};
Point(2) = {a, 0, 0};
Point(3) = {0, b, 0};
Line(1) = {1, 2};
Ellipse(2) = {2, 1, 2, 3};
Line(3) = {3, 1};
Curve Loop(1) = {1, 2, 3};
Plane Surface(1) = {1};

Physical Surface("body") = {1};
Physical Curve("surface") = {1};
Physical Curve("far") = {2};
Physical Curve("axis") = {3};

MeshSize{ : } = h;
Mesh.Algorithm = 6; // Frontal-Delaunay
