// A quarter of the unit disc: the mesh of the sector_*.msh beside this file.
SetFactory("Built-in");
Point(1) = {0, 0, 0, 0.5};
Point(2) = {1, 0, 0, 0.5};
Point(3) = {0, 1, 0, 0.5};
Line(1) = {1, 2};
Circle(2) = {2, 1, 3};
Line(3) = {3, 1};
Curve Loop(1) = {1, 2, 3};
Plane Surface(1) = {1};
Physical Curve("arc", 5) = {2};
Physical Curve("straight", 7) = {1, -3};
Physical Surface("body", 9) = {1};
