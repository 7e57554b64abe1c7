// A body like a half plane, (-L, L) x (0, L), in graded rows of quadrilaterals: n of equal length where it may touch, |x| < b, and as
// many rows as long as they are high there. Units: m.
DefineConstant[ L = 20, b = 0.06, n = 48 ];
h = 2*b/n;
ratio = 1.4;
m = Round(Log(1 + (L - b)*(ratio - 1)/h)/Log(ratio));
rows = Round(Log(1 + (L - b)*(ratio - 1)/h)/Log(ratio));
Point(1) = {-L, 0, 0}; Point(2) = {-b, 0, 0}; Point(3) = {b, 0, 0}; Point(4) = {L, 0, 0};
Point(5) = {-L, b, 0}; Point(6) = {-b, b, 0}; Point(7) = {b, b, 0}; Point(8) = {L, b, 0};
Point(9) = {-L, L, 0}; Point(10) = {-b, L, 0}; Point(11) = {b, L, 0}; Point(12) = {L, L, 0};
For j In {0:2}
  For i In {1:3}
    Line(10*j + i) = {4*j + i, 4*j + i + 1};
  EndFor
EndFor
For j In {0:1}
  For i In {1:4}
    Line(100 + 10*j + i) = {4*j + i, 4*j + i + 4};
  EndFor
EndFor
For j In {0:2}
  Transfinite Curve{10*j + 1} = m + 1 Using Progression 1/ratio;
  Transfinite Curve{10*j + 2} = n + 1;
  Transfinite Curve{10*j + 3} = m + 1 Using Progression ratio;
EndFor
For i In {1:4}
  Transfinite Curve{100 + i} = n/2 + 1;
  Transfinite Curve{110 + i} = rows + 1 Using Progression ratio;
EndFor
For j In {0:1}
  For i In {1:3}
    Curve Loop(10*j + i) = {10*j + i, 100 + 10*j + i + 1, -(10*(j + 1) + i), -(100 + 10*j + i)};
    Plane Surface(10*j + i) = {10*j + i};
    Transfinite Surface{10*j + i};
    Recombine Surface{10*j + i};
  EndFor
EndFor
Physical Surface("body") = {1, 2, 3, 11, 12, 13};
Physical Curve("contact") = {2};
Physical Curve("top") = {21, 22, 23};
