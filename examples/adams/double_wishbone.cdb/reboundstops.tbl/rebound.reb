$---------------------------------------------------------------------MDI_HEADER
[MDI_HEADER]
 FILE_TYPE     =  'reb'
 FILE_VERSION  =  4.0
 FILE_FORMAT   =  'ASCII'
$--------------------------------------------------------------------------UNITS
[UNITS]
 LENGTH  =  'mm'
 ANGLE   =  'degrees'
 FORCE   =  'newton'
 MASS    =  'kg'
 TIME    =  'second'
$--------------------------------------------------------------------------CURVE
[CURVE]
{ disp force }
              0.0              0.0
              4.0           2500.0
              8.0           8000.0
             12.0          18000.0
             16.0          32000.0
