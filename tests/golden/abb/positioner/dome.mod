MODULE dome
  ! Robotic AM
  ! w_am is on the face of STN1, and seen from its user frame
  ! set the load of t_am: mass and centre of gravity of what the robot carries
  ! 2 parts of 2695 bytes in all, loaded from HOME:/ one after the other
  PROC main()
    Load \Dynamic,"HOME:/dome01.mod";
    %"dome01_p"%;
    UnLoad "HOME:/dome01.mod";
    Load \Dynamic,"HOME:/dome02.mod";
    %"dome02_p"%;
    UnLoad "HOME:/dome02.mod";
  ENDPROC
ENDMODULE
