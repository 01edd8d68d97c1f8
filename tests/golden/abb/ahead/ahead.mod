MODULE ahead
  ! Robotic AM
  ! set the load of t_am: mass and centre of gravity of what the robot carries
  LOCAL PERS tooldata t_am:=[TRUE,[[0.000,0.000,150.000],[0.9689124,0.0000000,0.0000000,0.2474040]],[0.001,[0,0,0.001],[1,0,0,0],0,0,0]];
  LOCAL PERS wobjdata w_am:=[FALSE,TRUE,"",[[700.000,10.500,-100.000],[0.0752729,-0.0959412,-0.0566580,0.9909183]],[[0,0,0],[1,0,0,0]]];
  LOCAL CONST speeddata v_am:=[1000,500,5000,1000];
  LOCAL CONST zonedata z_am1:=[FALSE,0.375,0.375,0.375,0.0375,0.375,0.0375];
  LOCAL CONST speeddata v_am1:=[6.000,500,5000,1000];
  LOCAL CONST speeddata v_am2:=[5.000,500,5000,1000];
  LOCAL VAR triggdata g_on1;
  LOCAL VAR triggdata g_off1;
  PROC main()
    ConfL\Off;
    SingArea\Off;
    TriggIO g_on1,0.3000\DOp:=do1,1;
    TriggIO g_off1,0.2500\DOp:=do1,0;
    ! layer 0
    MoveAbsJ [[0.0000,-30.0000,120.0000,0.0000,60.0000,0.0000],[9E9,9E9,9E9,9E9,9E9,9E9]]\NoEOffs,v_am\T:=0.50000,fine,t_am\WObj:=w_am;
    TriggL [[12.000,0.250,105.000],[0.7071068,0.0000000,0.0000000,0.7071068],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v_am1,g_on1,fine,t_am\WObj:=w_am;
    MoveL [[10.000,0.250,105.000],[1.0000000,0.0000000,0.0000000,0.0000000],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v_am\V:=5.000,z_am1,t_am\WObj:=w_am;
    MoveL [[12.000,0.250,105.000],[0.7071068,0.0000000,0.0000000,0.7071068],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v_am\V:=5.000,z_am1,t_am\WObj:=w_am;
    TriggL [[14.000,0.500,105.000],[0.0000000,0.0000000,1.0000000,0.0000000],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v_am2,g_off1,fine,t_am\WObj:=w_am;
    ! layer 1
    MoveAbsJ [[0.5000,-30.0000,120.0000,0.0000,60.0000,0.0000],[9E9,9E9,9E9,9E9,9E9,9E9]]\NoEOffs,v_am\T:=0.50000,fine,t_am\WObj:=w_am;
    TriggL [[12.000,0.250,106.000],[0.7071068,0.0000000,0.0000000,0.7071068],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v_am1,g_on1,fine,t_am\WObj:=w_am;
    MoveL [[10.000,0.250,105.000],[1.0000000,0.0000000,0.0000000,0.0000000],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v_am\V:=5.000,z_am1,t_am\WObj:=w_am;
    MoveL [[12.000,0.250,106.000],[0.7071068,0.0000000,0.0000000,0.7071068],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v_am\V:=5.000,z_am1,t_am\WObj:=w_am;
    TriggL [[14.000,0.500,105.000],[0.0000000,0.0000000,1.0000000,0.0000000],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v_am2,g_off1,fine,t_am\WObj:=w_am;
  ENDPROC
ENDMODULE
