// Section of the lower half of a ball of radius R on the plane y = 0; x is the radius and y the axis. The top moved down by 0.02 makes the
// contact end at x = 0.146, on a foundation with the yield stress 100 at 0.157: between inner and outer. Units: m.
DefineConstant[ R = 1, inner = 0.14, outer = 0.16, h = 0.0003 ];

Point(1) = {0, R, 0};
Point(2) = {0, 0, 0};
Point(3) = {R, R, 0};
Circle(1) = {2, 1, 3};
Line(2) = {3, 1};
Line(3) = {1, 2};
Curve Loop(1) = {1, 2, 3};
Plane Surface(1) = {1};

Physical Surface("body") = {1};
Physical Curve("skin") = {1};
Physical Curve("top") = {2};
Physical Curve("axis") = {3};

// Cells of size h between inner and outer, of 10 h in the contact, and of 50 h at the edge of the clamped top, growing with the distance
// from there.
below = Sprintf("(%g - Sqrt(x^2 + (y - %g)^2))^2", R, R); // the depth below the skin, squared
Field[1] = MathEval;
Field[1].F = StrCat(Sprintf("%g + 0.15 * Sqrt((0.5 * (Abs(x - %g) + Abs(x - %g) - %g))^2 + ", h, inner, outer, outer - inner), below, ")");
Field[2] = MathEval;
Field[2].F = StrCat(Sprintf("%g + 0.15 * Sqrt((0.5 * (Abs(x - %g) + x - %g))^2 + ", 10 * h, inner, inner), below, ")");
Field[3] = MathEval;
Field[3].F = Sprintf("%g + 0.2 * Sqrt((x - %g)^2 + (y - %g)^2)", 50 * h, R, R);
Field[4] = Min;
Field[4].FieldsList = {1, 2, 3};
Background Field = 4;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.Algorithm = 6; // Frontal-Delaunay
