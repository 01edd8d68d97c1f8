MODULE both
  ! Robotic AM
  ! eax_c is the track in mm, which moves the base frame of the robot
  ! w_am is on the face of STN1, and seen from its user frame
  ! set the load of t_am: mass and centre of gravity of what the robot carries
  ! 2 parts of 2755 bytes in all, loaded from HOME:/ one after the other
  PROC main()
    Load \Dynamic,"HOME:/both01.mod";
    %"both01_p"%;
    UnLoad "HOME:/both01.mod";
    Load \Dynamic,"HOME:/both02.mod";
    %"both02_p"%;
    UnLoad "HOME:/both02.mod";
  ENDPROC
ENDMODULE
