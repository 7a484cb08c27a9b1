(define (problem usar-room5)
  (:domain usar)
  (:objects
    hall1 hall2 hall3 hall4 hall5 hall6 hall7 hall8 room1 room2 room3 room4
    room5 room6 room7 room8 room9 room10 room11 room12 room13 - location
    mk1 mk2 - medkit
    robot - machine
    commx - person
  )
  (:init
    (connected hall1 hall2)
    (connected hall2 hall3)
    (connected hall3 hall4)
    (connected hall4 hall5)
    (connected hall5 hall6)
    (connected hall6 hall7)
    (connected hall7 hall8)
    (connected room1 hall1)
    (connected room9 hall1)
    (connected room10 hall1)
    (connected room2 hall2)
    (connected room4 hall4)
    (connected room11 hall4)
    (connected room3 room4)
    (connected room5 hall5)
    (connected room12 hall5)
    (connected room7 hall7)
    (connected room6 room7)
    (connected room8 hall8)
    (connected room13 hall8)
    (at commx room13)
    (at robot room4)
    (at mk1 room5)
    (at mk2 room3)
  )
  (:goal (and (conducted_triage commx room1))))
