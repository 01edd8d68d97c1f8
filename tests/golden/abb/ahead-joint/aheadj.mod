MODULE aheadj
  ! Robotic AM
  ! A remark ]]> with "marks": Grosse
  ! t_am is the nozzle, which stands; w_am is what the robot holds
  ! set the load of t_am: mass and centre of gravity of what the robot carries
  LOCAL PERS tooldata t_am:=[FALSE,[[300.000,0.000,310.500],[0.7071068,0.0000000,0.0000000,0.7071068]],[0.001,[0,0,0.001],[1,0,0,0],0,0,0]];
  LOCAL PERS wobjdata w_am:=[TRUE,TRUE,"",[[0.000,0.000,5.000],[1.0000000,0.0000000,0.0000000,0.0000000]],[[0,0,0],[1,0,0,0]]];
  LOCAL CONST speeddata v_am:=[1000,500,5000,1000];
  LOCAL CONST zonedata z_am1:=[FALSE,0.600,0.600,0.600,0.0600,0.600,0.0600];
  LOCAL VAR triggdata g_on;
  LOCAL VAR triggdata g_off;
  PROC main()
    ConfL\Off;
    SingArea\Off;
    TriggIO g_on,0\DOp:=do3,1;
    TriggIO g_off,0\DOp:=do3,0;
    ! layer 0
    MoveAbsJ [[0.0000,-30.0000,120.0000,0.0000,60.0000,170.0000],[9E9,9E9,9E9,9E9,9E9,9E9]]\NoEOffs,v_am\T:=10.00000,fine,t_am\WObj:=w_am;
    TriggAbsJ [[1.2500,-29.5000,120.2500,0.1000,60.5000,175.0000],[9E9,9E9,9E9,9E9,9E9,9E9]]\NoEOffs,v_am\T:=0.80000,g_on,fine,t_am\WObj:=w_am;
    MoveAbsJ [[1.2500,-29.5000,120.2500,0.1000,60.5000,176.0000],[9E9,9E9,9E9,9E9,9E9,9E9]]\NoEOffs,v_am\T:=0.20000,z_am1,t_am\WObj:=w_am;
    TriggAbsJ [[1.2500,-29.5000,120.3000,0.1000,60.5000,177.4000],[9E9,9E9,9E9,9E9,9E9,9E9]]\NoEOffs,v_am\T:=0.25000,g_off,fine,t_am\WObj:=w_am;
    WaitTime 12.500;
    WaitDI di3,1;
    WaitAI ai2,\LT,1.250000;
    clean;
    ! layer 1
    MoveAbsJ [[0.0000,-30.0000,120.0000,0.0000,60.0000,177.4000],[9E9,9E9,9E9,9E9,9E9,9E9]]\NoEOffs,v_am\T:=1.00000,fine,t_am\WObj:=w_am;
  ENDPROC
ENDMODULE
