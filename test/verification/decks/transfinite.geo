// A block, 2 x 1, whose curves are divided whatever the size factor is. Units: m.
Point(1) = {0, 0, 0};
Point(2) = {2, 0, 0};
Point(3) = {2, 1, 0};
Point(4) = {0, 1, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve {1, 3} = 25;
Transfinite Curve {2, 4} = 13;
Transfinite Surface {1};
Physical Surface("body") = {1};
Physical Curve("bottom") = {1};
Physical Curve("top") = {3};
